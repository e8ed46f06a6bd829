"""Closed triangulated surfaces: their files, checks, distances and nodes."""
