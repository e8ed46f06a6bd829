"""What the simulation gets wrong, why, and what an extension gains."""
