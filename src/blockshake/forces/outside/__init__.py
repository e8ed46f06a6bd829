"""A force from outside that nobody thought of: on which block, when, how large, and which law it looks like."""
