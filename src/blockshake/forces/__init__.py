"""Joint forces: the forces that the joints must have transmitted, computed from the readings alone."""
