"""Figures, tables and pages: from Datasets to files; nothing is computed here."""
