"""Markers, accelerometers and displacement transducers: what they read of a motion, and their noise."""
