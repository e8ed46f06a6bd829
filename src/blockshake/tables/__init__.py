"""Tables of users: cells as written, and units."""
