"""Parity checks of sensors against each other: faults that show without a simulation."""
