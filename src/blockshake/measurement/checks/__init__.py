"""Whether a campaign is what it states: units, rates, places, noise."""
