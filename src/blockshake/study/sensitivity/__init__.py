"""Sensitivities of the response to the sampled variables."""
