"""Laws of the joints, read off their forces: each a number with its standard error."""
