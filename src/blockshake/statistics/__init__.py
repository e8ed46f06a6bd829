"""Scores of ensembles, resampling, and intervals of statistics of few samples."""
