"""Campaigns as they lie in files."""
