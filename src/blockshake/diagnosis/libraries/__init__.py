"""Simulated tests: nominal draws, and draws with each candidate effect."""
