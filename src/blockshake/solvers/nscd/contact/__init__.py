"""Contacts of convex polyhedra: detection and warm start."""
