"""Latin hypercube sampling with correlation control."""
