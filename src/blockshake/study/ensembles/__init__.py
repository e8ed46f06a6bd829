"""Ensembles of samples, their envelopes and what they cover."""
