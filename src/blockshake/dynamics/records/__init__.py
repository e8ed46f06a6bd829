"""Readers of strong-motion files, one a format; each turns a text into arrays in SI units."""
