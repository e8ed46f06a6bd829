"""How far ensembles of curves are apart, how wide each is, and how far it is from a measured curve.

All are means of the differences between two curves, so that the pairs are compared once for all of them.
"""

from math import comb

import numpy as np

from blockshake.study.ensembles.intervals import CONFIDENCE, sample_quantiles

FEWEST = 3  # samples; of fewer an ensemble has no width that could be told from chance
_DRAWS = 400


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
    found = np.empty((len(curves), len(others), curves.shape[2]))
    for place, curve in enumerate(curves):
        apart = np.abs(others - curve)
        count = np.isfinite(apart).sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            found[place] = np.where(count > 0, np.nansum(apart, axis=1) / count, np.nan)
    return found


def ensemble_distance(differences, own, other):
    """Energy distance of two ensembles, in the unit of the curves.

    Parameters
    ----------
    differences : float64 array, shape (n, n)
        Of all members from each other, from `mean_differences`.
    own, other : int arrays
        Places of the members of either ensemble; none in both.

    Returns
    -------
    float
        ``mean |X - Y| - mean |X - X'| / 2 - mean |Y - Y'| / 2``, means over all pairs, a member with itself included:
        zero for equal ensembles, the shift for two that are narrow and far apart, never below zero for whole curves.

    Notes
    -----
    Szekely and Rizzo (2013), J. Stat. Plan. Inference 143, at every time by itself, mean over the times: the integral
    over the squared difference of both distribution functions. Ensembles of few members are apart by chance already,
    see `chance_distance`.
    """
    between = differences[np.ix_(own, other)].mean()
    within = differences[np.ix_(own, own)].mean() + differences[np.ix_(other, other)].mean()
    return float(between - 0.5 * within)


def chance_distance(differences, own, other, generator):
    """Distance that 95 of 100 random divisions of all members into ensembles of these sizes stay below.

    Arguments as of `ensemble_distance`. NaN where the members are so few that a twentieth of their divisions or more
    are as far apart as the farthest. A sample that both models ran makes the ensembles more alike than the division
    takes them to be, so that a distance beyond this level is rarer by chance than stated.
    """
    # the same two groups come twice where they are of one size
    alike = (1 + (len(own) == len(other))) / comb(len(own) + len(other), len(own))
    if alike >= 1.0 - CONFIDENCE:
        return np.nan
    pooled, size = np.concatenate([own, other]), len(own)
    drawn = []
    for _ in range(_DRAWS):
        mixed = generator.permutation(pooled)
        drawn.append(ensemble_distance(differences, mixed[:size], mixed[size:]))
    return float(np.quantile(drawn, CONFIDENCE))


def resampled_weights(size, generator):
    """How often each member is drawn in a bootstrap, float64 (n_draws, size); once each in the first row."""
    drawn = generator.multinomial(size, np.full(size, 1.0 / size), size=_DRAWS).astype(float)
    return np.concatenate([np.ones((1, size)), drawn])


def mean_width(differences, weights):
    """Mean absolute difference of two different members, which does not grow with their number.

    Parameters
    ----------
    differences : float64 array, shape (n, n, ...)
        Zero for a member and itself.
    weights : float64 array, shape (n_draws, n)
        From `resampled_weights`. A member drawn twice is not held against itself.

    Returns
    -------
    float64 array, shape (n_draws, ...)
        NaN where a draw has one member only.
    """
    total = np.einsum("di,ij...,dj->d...", weights, differences, weights)
    pairs = weights.sum(axis=1) ** 2 - (weights**2).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total / pairs.reshape(-1, *[1] * (total.ndim - 1))


def ensemble_score(away, differences, weights):
    """Continuous ranked probability score of an ensemble against curves, fair to few members: float64 (n_draws, ...).

    ``away`` (n, ...): mean differences of the members from each curve; the others as of `mean_width`. The score of
    `blockshake.study.ensembles.scores.crps`, mean over the times.
    """
    total = weights.sum(axis=1).reshape(-1, *[1] * (away.ndim - 1))
    return weights @ away / total - 0.5 * mean_width(differences, weights)


def member_scores(differences):
    """Score of every member by the others, as of `ensemble_score`: float64 (n, ...); their mean is half the width.

    ``differences`` as of `mean_width`, of three members at least.
    """
    count, away = len(differences), differences.sum(axis=1)
    pairs = 0.5 * away.sum(axis=0)
    return away / (count - 1) - (pairs - away) / ((count - 1) * (count - 2))


def limits_of(drawn, confidence=CONFIDENCE):
    """Bootstrap interval of values along the first axis: float64 array, shape (2, ...)."""
    tail = 0.5 - 0.5 * confidence
    return sample_quantiles(drawn, (tail, 1.0 - tail))


def parting_time(time, curve, other, limit):
    """First time at which two curves differ by more than a limit at any marker [s]; infinite if they never do.

    ``curve``, ``other`` (n_times, n_markers) [m]; a run that ended before the other differs from then on.
    """
    with np.errstate(invalid="ignore"):
        beyond = np.abs(curve - other) > limit
    beyond |= np.isfinite(curve) != np.isfinite(other)
    parted = beyond.any(axis=1)
    return float(time[np.argmax(parted)]) if parted.any() else np.inf
