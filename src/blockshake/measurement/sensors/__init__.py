"""Markers and accelerometers: what they read of a motion, and their noise."""
