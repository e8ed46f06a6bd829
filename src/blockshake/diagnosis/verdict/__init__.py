"""The verdict, its wording and its track record."""
