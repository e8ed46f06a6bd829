"""Contact stiffness from the speed of waves."""
