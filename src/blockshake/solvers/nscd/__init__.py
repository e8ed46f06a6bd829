"""Nonsmooth contact dynamics of rigid polyhedra, implicit in time."""
