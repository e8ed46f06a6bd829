"""One likelihood of all forces of a campaign: every cause states which forces it makes, and the readings decide."""
