"""Figures of the study's report."""
