"""The study's report: what its sections share, and sections of no analysis alone."""
