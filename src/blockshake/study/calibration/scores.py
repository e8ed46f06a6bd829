"""How well the samples near a value of a parameter predict a test: a proper score of weighted samples."""

from typing import NamedTuple

import numpy as np

from blockshake.statistics.resampling import rank_chance
from blockshake.statistics.scores import ensemble_score

_HALF_WIDTH = 0.2  # of a parameter's range, within which samples count for a value


class Distances(NamedTuple):
    """How far the samples' readings of one test are from the measured ones and from each other.

    Attributes
    ----------
    to_test : float64 array, shape (n_samples,)
        NaN for a sample without an answer [1].
    between : float64 array, shape (n_samples, n_samples)
        Symmetric; NaN likewise [1].
    """

    to_test: np.ndarray
    between: np.ndarray


def distances(readings, measured):
    """`Distances` of readings of any kind at the same places: times and markers, or frequencies and channels.

    Parameters
    ----------
    readings : float64 array, shape (n_samples, ...)
        With the instrument's noise; NaN all over for a sample without an answer.
    measured : float64 array, shape (...)
        NaN is a gap.

    Notes
    -----
    Differences are taken over the mean difference, at the place, of two readings among those of the test and of all
    samples. Every time and every channel weighs alike: the first millimetres of a slip count as much as the late
    decimetres of rocking that nobody predicts. A place where all read the same is left out.
    """
    readings, measured = np.reshape(readings, (len(readings), -1)), np.reshape(measured, -1)
    answered = np.isfinite(readings).all(axis=1)
    known = np.isfinite(measured)
    every = np.sort(np.concatenate([readings[answered], measured[None]])[:, known], axis=0)
    rank = 2.0 * np.arange(1, len(every) + 1) - len(every) - 1
    scale = 2.0 * rank @ every / (len(every) * max(len(every) - 1, 1))
    known[known], scale = scale > 0.0, scale[scale > 0.0]
    count = len(readings)
    to_test, between = np.full(count, np.nan), np.full((count, count), np.nan)
    if known.any():
        scaled = readings[:, known] / scale
        to_test = np.abs(scaled - measured[known] / scale).mean(axis=1)
        for sample in np.flatnonzero(answered):
            between[sample] = np.abs(scaled - scaled[sample]).mean(axis=1)
    return Distances(to_test, between)


def weights_near(shares, values):
    """Weights of samples for values of a parameter, each row of sum 1, shape (n_values, n_samples).

    Parameters
    ----------
    shares : float64 array, shape (n_samples,)
        Where the samples lie in the parameter's range, 0 to 1.
    values : float64 array, shape (n_values,)
        Likewise.

    Notes
    -----
    Epanechnikov's kernel, a fifth of the range to each side.
    """
    weights = np.maximum(1.0 - ((values[:, None] - shares) / _HALF_WIDTH) ** 2, 0.0)
    return weights / weights.sum(axis=1, keepdims=True)


def weighted_scores(weights, found):
    """`ensemble_score` of weighted samples, mean over the places of `distances`, shape (...,) [1].

    ``weights`` (..., n_samples); ``found``: `Distances`. Samples without an answer have no weight. With equal weights
    the score is 0.5 in the mean where the test is one more of the samples' kind.
    """
    return ensemble_score(*map(np.nan_to_num, found), weights * np.isfinite(found.to_test))


def chance_of_test(found):
    """`rank_chance` of the test's mean distance from the samples among those of the samples from the others [1].

    A test that no sample resembles has the chance 1 / (n_samples + 1).
    """
    answered = np.isfinite(found.to_test)
    count = int(answered.sum())
    if count < 2:
        return np.nan
    own = np.nansum(found.between[np.ix_(answered, answered)], axis=1) / (count - 1)
    return float(rank_chance(found.to_test[answered].mean(), own))
