"""How sure a statistic of few samples is: shares and quantiles with their intervals."""

from typing import NamedTuple

import numpy as np
from scipy.stats import beta, binom

CONFIDENCE = 0.95
SURE_FROM = 6  # samples, from which order statistics enclose the median in 95 of 100 cases
_DRAWS = 400


def share_interval(count, trials):
    """Interval of 95 % for the probability of an event that was met ``count`` times in ``trials``.

    Parameters
    ----------
    count, trials : int

    Returns
    -------
    lower, upper : float
        [1]; 0 and 1 without trials.

    Notes
    -----
    Clopper and Pearson (1934): never holds the probability in fewer than 95 of 100 cases, often in more. It takes the
    trials as independent; those of a Latin hypercube are spread more evenly, which makes it wider still.
    """
    tail = 0.5 - 0.5 * CONFIDENCE
    lower = beta.ppf(tail, count, trials - count + 1) if count > 0 else 0.0
    upper = beta.ppf(1.0 - tail, count + 1, trials - count) if count < trials else 1.0
    return float(lower), float(upper)


def sample_quantiles(values, probabilities):
    """Quantiles over the first axis of the values that are there, linear between ordered values.

    Parameters
    ----------
    values : float64 array, shape (n_samples, ...)
        NaN is no value.
    probabilities : float64 array, shape (n_probabilities,)
        In [0, 1].

    Returns
    -------
    float64 array, shape (n_probabilities, ...)
        NaN where no sample has a value. Type 7 of Hyndman and Fan (1996).
    """
    if len(values) == 0:
        return np.full((len(probabilities), *values.shape[1:]), np.nan)
    ordered = np.sort(values, axis=0)  # NaN last
    last = np.maximum(np.isfinite(ordered).sum(axis=0) - 1, 0)
    rows = []
    for probability in probabilities:
        place = probability * last
        below = np.floor(place).astype(np.int64)
        low = np.take_along_axis(ordered, below[None], axis=0)[0]
        high = np.take_along_axis(ordered, np.minimum(below + 1, last)[None], axis=0)[0]
        rows.append(low + (place - below) * (high - low))
    return np.stack(rows)


class Median(NamedTuple):
    """Median of a sample with its limits; NaN without values."""

    median: float
    lower: float
    upper: float


def median_interval(values):
    """`Median` with limits of 95 % that are values of the sample, whatever their distribution.

    Parameters
    ----------
    values : float64 array, shape (n_samples,)
        NaN is no value.

    Notes
    -----
    Order statistics (Conover 1999, Practical Nonparametric Statistics, section 3.2): the k-th smallest and the k-th
    largest value enclose the median of independent samples with probability ``1 - 2 P(B < k)``, B binomial with n and
    1/2. Fewer than six samples reach no 95 %: the limits of n are then their smallest and largest value, which enclose
    the median with probability ``1 - 2^(1 - n)``.

    Examples
    --------
    >>> median_interval(np.array([3.0, 1.0, 2.0]))
    Median(median=2.0, lower=1.0, upper=3.0)
    """
    ordered = np.sort(np.asarray(values, dtype=float))
    ordered = ordered[np.isfinite(ordered)]
    size = len(ordered)
    if size == 0:
        return Median(np.nan, np.nan, np.nan)
    place = max(int(binom.ppf(0.5 - 0.5 * CONFIDENCE, size, 0.5)), 1)
    return Median(*(float(one) for one in (np.median(ordered), ordered[place - 1], ordered[size - place])))


def quantile_interval(values, probabilities, generator):
    """Bootstrap interval of 95 % of quantiles over the first axis.

    Parameters
    ----------
    values, probabilities
        As in `sample_quantiles`.
    generator : numpy.random.Generator

    Returns
    -------
    float64 array, shape (2, n_probabilities, ...)
        Lower and upper limits: percentiles of the quantiles of samples drawn again with replacement.

    Notes
    -----
    It cannot reach beyond the largest sample. Of 50 independent samples it holds the median in 93 of 100 cases, but the
    quantiles 5 and 95 % in 88 only, the misses lying outside the samples; of 20 samples in 65.
    """
    if len(values) == 0:
        return np.full((2, len(probabilities), *values.shape[1:]), np.nan)
    drawn = np.stack(
        [
            sample_quantiles(values[generator.integers(0, len(values), len(values))], probabilities)
            for _ in range(_DRAWS)
        ]
    )
    return sample_quantiles(drawn, (0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE))
