"""Diagnosis of measured tests: errors of the simulation, their cause, and the gain of an extended model."""
