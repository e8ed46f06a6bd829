"""Rotations, states of bodies, ground motion and the recorder of a run."""
