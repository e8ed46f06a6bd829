"""Inference: evidence of each candidate, decision, and size of the cause."""
