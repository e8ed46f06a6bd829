"""How sure a statistic of few samples is: shares and quantiles with their intervals."""

from itertools import count

import numpy as np
import scipy

CONFIDENCE = 0.95
SURE_FROM = 6  # samples: `samples_needed` for the median


def share_interval(count, trials, unknown=0):
    """Interval of 95 % for the probability of an event that was met ``count`` times in ``trials``.

    It holds whatever came of ``unknown`` more trials: the lower limit takes them as none, the upper one as all met.

    Returns
    -------
    lower, upper : float
        [1]; 0 and 1 without trials.

    Notes
    -----
    Clopper and Pearson (1934): never holds the probability in fewer than 95 of 100 cases, often in more. It takes the
    trials as independent; those of a Latin hypercube are spread more evenly, which makes it wider still.
    """
    tail, beta = 0.5 - 0.5 * CONFIDENCE, scipy.stats.beta
    lower = beta.ppf(tail, count, trials + unknown - count + 1) if count > 0 else 0.0
    upper = beta.ppf(1.0 - tail, count + unknown + 1, trials - count) if count < trials else 1.0
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
        index = probability * last
        below = np.floor(index).astype(np.int64)
        low = np.take_along_axis(ordered, below[None], axis=0)[0]
        high = np.take_along_axis(ordered, np.minimum(below + 1, last)[None], axis=0)[0]
        rows.append(low + (index - below) * (high - low))
    return np.stack(rows)


def quantile_ranks(size, probability):
    """Ranks of the two values of a sample that are the limits of 95 % of a quantile, whatever the distribution.

    Parameters
    ----------
    size : int
        The sample.
    probability : float
        Probability of a smaller value, in (0, 1).

    Returns
    -------
    (int, int) or None
        From 1, the smallest; None of a sample so small that its smallest and largest value enclose the quantile in
        fewer than 95 of 100 cases.

    Notes
    -----
    Order statistics (Conover 1999, Practical Nonparametric Statistics, section 3.2): the k-th and the m-th smallest
    of independent values enclose the quantile with probability ``P(k <= B < m)``, B binomial. Each limit misses it in
    at most 2.5 of 100 cases; where not even the outermost value does so, the other limit makes up for that.

    Examples
    --------
    >>> quantile_ranks(50, 0.5), quantile_ranks(58, 0.95), quantile_ranks(59, 0.95)
    ((18, 33), None, (50, 59))
    """
    tail, binom = 0.5 - 0.5 * CONFIDENCE, scipy.stats.binom(size, probability)
    lower = max(int(binom.ppf(tail)), 1)
    upper = min(int(binom.ppf(1.0 - tail)) + 1, size)

    def holds():
        return binom.cdf(upper - 1) - binom.cdf(lower - 1) >= CONFIDENCE

    while not holds() and lower > 1:
        lower -= 1
    while not holds() and upper < size:
        upper += 1
    return (lower, upper) if size and holds() else None


def samples_needed(probability):
    """Samples from which a quantile has limits of 95 %: 6 of the median, 59 of the quantile 95 %."""
    return next(size for size in count(1) if quantile_ranks(size, probability))


def quantile_interval(values, probabilities):
    """Limits of 95 % of quantiles over the first axis, by `quantile_ranks` of the values that are there.

    Parameters
    ----------
    values, probabilities
        As in `sample_quantiles`.

    Returns
    -------
    float64 array, shape (2, n_probabilities, ...)
        Lower and upper limits; NaN where there are too few values.
    """
    limits = np.full((2, len(probabilities), *values.shape[1:]), np.nan)
    ordered, sizes = np.sort(values, axis=0), np.isfinite(values).sum(axis=0)
    for size in np.unique(sizes):
        for index, probability in enumerate(probabilities):
            ranks = quantile_ranks(int(size), probability)
            if ranks:
                for side, rank in enumerate(ranks):
                    limits[side, index] = np.where(sizes == size, ordered[rank - 1], limits[side, index])
    return limits
