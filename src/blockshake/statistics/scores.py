"""How far ensembles of curves are apart, how wide each is, and how far it is from a measured curve.

All are means of the differences between two curves, so that the pairs are compared once for all of them.
"""

import numpy as np

FEWEST = 3  # samples; of fewer an ensemble has no width that could be distinguished from chance


def mean_differences(curves, others):
    """Mean absolute difference of every curve from every other one over the times that both have.

    Parameters
    ----------
    curves, others : float64 arrays, shape (n, n_times, n_markers) and (m, n_times, n_markers)
        [m]; NaN, as after the end of a run, is no value.

    Returns
    -------
    float64 array, shape (n, m, n_markers)
        [m]; NaN for two curves without a common time.
    """
    means, same = np.empty((len(curves), len(others), curves.shape[2])), others is curves
    for row, curve in enumerate(curves):
        # pair by pair, which a cache holds
        for column in range(row if same else 0, len(others)):
            apart = np.abs(others[column] - curve)
            count = np.isfinite(apart).sum(axis=0)
            with np.errstate(invalid="ignore", divide="ignore"):
                means[row, column] = np.where(count > 0, np.nansum(apart, axis=0) / count, np.nan)
            if same:
                means[column, row] = means[row, column]
    return means


def ensemble_distance(differences, first, second):
    """Energy distance of two ensembles, in the unit of the curves.

    Parameters
    ----------
    differences : float64 array, shape (n, n)
        Mean differences of all members from each other, from `mean_differences`.
    first, second : int arrays
        Rows of the members of either ensemble; none in both.

    Returns
    -------
    float
        ``mean |X - Y| - mean |X - X'| / 2 - mean |Y - Y'| / 2``, means over all pairs, a member with itself included:
        zero for equal ensembles, the shift for two that are narrow and far apart, never below zero for whole curves.

    Notes
    -----
    Szekely and Rizzo (2013), J. Stat. Plan. Inference 143, at every time by itself, mean over the times: the integral
    over the squared difference of both distribution functions. Ensembles of few members are apart by chance already,
    see `blockshake.statistics.resampling.chance_distance`.
    """
    between = differences[np.ix_(first, second)].mean()
    within = differences[np.ix_(first, first)].mean() + differences[np.ix_(second, second)].mean()
    return float(between - 0.5 * within)


def mean_width(differences, weights):
    """Mean absolute difference of two different members, which does not grow with their number.

    Parameters
    ----------
    differences : float64 array, shape (n, n, ...)
        Zero for a member and itself.
    weights : float64 array, shape (*draws, n)
        From `resampled_weights`, or any others. A member drawn twice is not held against itself.

    Returns
    -------
    float64 array, shape (*draws, ...)
        NaN where a draw has one member only.
    """
    inner = (1,) * (differences.ndim - 2)
    total = (np.tensordot(weights, differences, 1) * weights.reshape(*weights.shape, *inner)).sum(
        axis=weights.ndim - 1
    )
    pairs = weights.sum(axis=-1) ** 2 - (weights**2).sum(axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total / pairs.reshape(*pairs.shape, *inner)


def ensemble_score(away, differences, weights):
    """Continuous ranked probability score of an ensemble against curves, float64 (*draws, ...).

    Parameters
    ----------
    away : float64 array, shape (n, ...)
        Mean differences of the members from each curve.
    differences, weights
        The same arguments as `mean_width` has.

    Notes
    -----
    ``sum_i w_i |X_i - y| - sum_(i != j) w_i w_j |X_i - X_j| / (2 (1 - sum_i w_i^2))`` with weights of sum 1, mean over
    the times: with equal weights the estimate that is fair to small ensembles (Ferro 2014, Q. J. R. Meteorol. Soc.
    140), for which no ensemble that is too narrow or too wide has an advantage.
    """
    total = weights.sum(axis=-1).reshape(*weights.shape[:-1], *(1,) * (away.ndim - 1))
    with np.errstate(invalid="ignore"):
        return np.tensordot(weights, away, 1) / total - 0.5 * mean_width(differences, weights)


def member_scores(differences):
    """`ensemble_score` of the other members for every member, float64 (n, ...); its mean is half the width.

    ``differences``: those that `mean_width` has, of three members at least.
    """
    count, away = len(differences), differences.sum(axis=1)
    pairs = 0.5 * away.sum(axis=0)
    return away / (count - 1) - (pairs - away) / ((count - 1) * (count - 2))
