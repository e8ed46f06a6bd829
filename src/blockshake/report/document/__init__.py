"""Blocks of a document, and how they become HTML and PDF."""
