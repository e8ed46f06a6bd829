"""A number that a law comes to, with its standard error."""

from typing import NamedTuple

import numpy as np


class Statistic(NamedTuple):
    """Value and standard error; both NaN where the test does not tell."""

    value: float
    error: float


UNTOLD = Statistic(np.nan, np.nan)


def of_blocks(values, block):
    """Median of values that go together in blocks, such as one swing's: the blocks' medians scatter independently.

    Parameters
    ----------
    values : float64 array, shape (n,)
    block : int array, shape (n,)
        Number of the block of each.

    Returns
    -------
    Statistic
        Mean of the blocks' medians, weighted by their lengths; untold with fewer than two blocks.
    """
    numbers, counts = np.unique(block, return_counts=True)
    if len(numbers) < 2:
        return UNTOLD
    medians = np.array([np.median(values[block == number]) for number in numbers])
    share = counts / counts.sum()
    mean = share @ medians
    spread = share @ (medians - mean) ** 2
    return Statistic(float(mean), float(np.sqrt(spread * (share**2).sum() / (1.0 - (share**2).sum()))))


def slopes(values, regressors, block):
    """Least squares of values on regressors and a constant, errors from blocks (Liang and Zeger 1986).

    Parameters
    ----------
    values : float64 array, shape (n,)
    regressors : float64 array, shape (n, n_regressors)
    block : int array, shape (n,)
        Number of the block of each; residuals of one block go together.

    Returns
    -------
    list of Statistic
        Of each regressor; untold with fewer blocks than coefficients and two more.
    """
    count = regressors.shape[1]
    numbers = np.unique(block)
    if len(numbers) < count + 3:
        return [UNTOLD] * count
    centred = regressors - regressors.mean(axis=0)
    scale = centred.std(axis=0)
    if (scale == 0.0).any():
        return [UNTOLD] * count
    design = np.column_stack([centred / scale, np.ones(len(values))])
    inverse = np.linalg.pinv(design.T @ design)
    found = inverse @ design.T @ values
    left = (values - design @ found)[:, None] * design
    sums = np.array([left[block == number].sum(axis=0) for number in numbers])
    covariance = inverse @ sums.T @ sums @ inverse * len(numbers) / (len(numbers) - count - 1)
    return [
        Statistic(float(found[place] / scale[place]), float(np.sqrt(covariance[place, place]) / scale[place]))
        for place in range(count)
    ]


def runs_of(mask):
    """Number of the run of neighbouring true entries that each belongs to, -1 elsewhere."""
    starts = mask & ~np.concatenate([[False], mask[:-1]])
    return np.where(mask, np.cumsum(starts) - 1, -1)
