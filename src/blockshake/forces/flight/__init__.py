"""The motion of a body that touches nothing, and what its impacts keep of it."""
