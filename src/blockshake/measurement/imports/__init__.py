"""Measured tests from spreadsheets and text files to campaigns."""
