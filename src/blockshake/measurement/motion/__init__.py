"""Motion of the base, the blocks and the joints, computed from readings."""
