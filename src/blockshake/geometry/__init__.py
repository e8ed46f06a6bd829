"""Shapes, level sets, surface nodes, polyhedra, mass properties and structures."""
