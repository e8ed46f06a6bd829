"""Features of a test, each with its error."""
