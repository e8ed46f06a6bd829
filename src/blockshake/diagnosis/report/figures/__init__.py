"""Figures of the diagnosis's report."""
