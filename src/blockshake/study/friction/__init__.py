"""Friction calibrated against measured tests."""
