"""Misfit of the nominal model to the readings."""
