"""Sections on calibrations against measured tests."""
