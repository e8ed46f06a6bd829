"""The equilibrium that a run starts from, and the stable step."""
