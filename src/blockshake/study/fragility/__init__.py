"""Fragility: how the probability of a potential collapse grows with the intensity of one motion."""
