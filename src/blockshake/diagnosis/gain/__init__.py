"""The extended model on sealed tests, against its rivals."""
