"""The virtual shake table: campaigns of synthetic tests whose truth is known, and kept apart."""
