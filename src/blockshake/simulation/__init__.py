"""One simulation: structure, motion and parameters in, a run Dataset out."""
