"""Limit states of a user's own: their probabilities, and their fragilities over the intensity."""
