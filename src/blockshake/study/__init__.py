"""Sampling, stiffness calibration, simulations of samples, envelopes."""
