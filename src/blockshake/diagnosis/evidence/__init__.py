"""One likelihood of all forces of a campaign: every cause says which forces it makes, and the readings decide."""
