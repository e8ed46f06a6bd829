"""Readings: campaigns in files, sensors, checks, the motion of the blocks."""
