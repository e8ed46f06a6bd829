"""Campaigns of which it is known alone whether the body fell or stood."""
