"""Whether a campaign is what it says: units, rates, places, noise."""
