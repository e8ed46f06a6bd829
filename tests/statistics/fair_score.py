"""The continuous ranked probability score by its double sum, for tests."""

import numpy as np


def crps(members, value):
    """``mean |X - y| - sum_ij |X_i - X_j| / (2 n (n - 1))`` (Ferro 2014) of members (n, ...) and a value (...)."""
    members, count = np.asarray(members), len(members)
    pairs = sum(np.abs(members - one).sum(axis=0) for one in members)
    return np.abs(members - value).mean(axis=0) - pairs / (2.0 * count * (count - 1))
