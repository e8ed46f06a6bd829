"""Friction, restitution, stiffness and flatness of contacts calibrated at once, against all open tests."""
