"""Proper scores: how far a measured value is from what an ensemble predicts, lowest in the mean for the truth."""

import numpy as np


def crps(members, value):
    """Continuous ranked probability score of an ensemble, in the unit of the value.

    Parameters
    ----------
    members : float64 array, shape (n_members, ...)
        NaN is no member.
    value : float64 array, shape (...)
        Measured; NaN where nothing was.

    Returns
    -------
    float64 array, shape (...)
        NaN where nothing was measured or fewer than two members are there.

    Notes
    -----
    ``mean |X - y| - sum_ij |X_i - X_j| / (2 n (n - 1))``: the estimate that is fair to small ensembles
    (Ferro 2014, Q. J. R. Meteorol. Soc. 140), for which no ensemble that is too narrow or too wide has an
    advantage. The double sum is taken over the ordered members, where it is a single one.
    """
    ordered = np.sort(np.asarray(members, dtype=float), axis=0)  # NaN last
    there = np.isfinite(ordered)
    count = there.sum(axis=0)
    filled = np.where(there, ordered, 0.0)
    rank = np.arange(1, len(ordered) + 1).reshape(-1, *[1] * (ordered.ndim - 1))
    spread = (np.where(there, 2 * rank - count - 1, 0) * filled).sum(axis=0)
    distance = np.where(there, np.abs(filled - value), 0.0).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        score = distance / count - spread / (count * (count - 1.0))
    return np.where((count > 1) & np.isfinite(value), score, np.nan)
