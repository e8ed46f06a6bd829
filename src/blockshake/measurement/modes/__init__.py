"""Frequencies and damping of a stack from noise and sine tests."""
