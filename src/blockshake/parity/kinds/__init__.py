"""Kinds of faults of sensors: a file a kind, with its equation, how it is found and how it is taken out."""
