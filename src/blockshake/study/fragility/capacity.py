"""Capacities known to lie between two levels of intensity, and the lognormal distribution that fits them."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.special import ndtr, ndtri

_DRAWS = 200
_SHARPEST, _WIDEST = 1e-6, 10.0  # dispersions that stand for none and for any [1]
_NEVER = 1e-300  # probability that stands for none [1]


class Capacity(NamedTuple):
    """Lognormal capacity: median, in the unit of the levels, and standard deviation of the logarithm [1]."""

    median: float
    dispersion: float

    def probability(self, level):
        """Probability of a capacity below a level, or levels [1]."""
        return ndtr((np.log(level) - np.log(self.median)) / max(self.dispersion, _SHARPEST))

    def level(self, probability):
        """Level below which the capacity lies with a probability, in the unit of the levels."""
        return self.median * np.exp(self.dispersion * ndtri(probability))


def fit_capacity(lower, upper):
    """Most likely `Capacity` of a sample of capacities that are known by their bounds.

    Parameters
    ----------
    lower, upper : float64 arrays, shape (n_samples,)
        The last level that was passed, 0 for none, and the first that was not, infinity for none.

    Returns
    -------
    Capacity
        NaN where no capacity has an upper bound or none a lower one: the data then bound the median on one side alone.
        A dispersion of 0, and the middle of the levels on a logarithmic scale, where one capacity would do for all: any
        median between the levels is then as likely as another.

    Notes
    -----
    Maximum likelihood of interval-censored values. Fragilities by maximum likelihood are Shinozuka et al.'s (2000);
    raising one motion until collapse is the incremental dynamic analysis of Vamvatsikos and Cornell (2002).
    """
    lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    if not len(lower) or np.isinf(upper).all() or (lower == 0.0).all():
        return Capacity(np.nan, np.nan)
    if lower.max() < upper.min():
        return Capacity(float(np.sqrt(lower.max() * upper.min())), 0.0)
    bounds, counts = np.unique(np.column_stack([lower, upper]), axis=0, return_counts=True)
    with np.errstate(divide="ignore"):
        low, high = np.log(bounds).T
    between = np.isfinite(low) & np.isfinite(high)
    ends = np.concatenate([low[np.isfinite(low)], high[np.isfinite(high)]])
    middle = 0.5 * (low[between] + high[between]) if between.any() else ends

    def unlikely(parameters):
        spread = np.exp(parameters[1])
        share = ndtr((high - parameters[0]) / spread) - ndtr((low - parameters[0]) / spread)
        return -counts @ np.log(np.maximum(share, _NEVER))

    start = np.mean(middle), np.log(0.5 * np.ptp(ends))
    limits = [(ends.min(), ends.max()), (np.log(_SHARPEST), np.log(_WIDEST))]
    found = minimize(
        unlikely, start, method="Nelder-Mead", bounds=limits, options={"xatol": 1e-6, "fatol": 1e-9}
    )
    return Capacity(float(np.exp(found.x[0])), float(np.exp(found.x[1])))


def bootstrap_capacities(lower, upper, generator):
    """`Capacity` of each of 200 samples drawn with replacement from the capacities of `fit_capacity`."""
    lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    draws = (generator.integers(len(lower), size=len(lower)) for _ in range(_DRAWS))
    return [fit_capacity(lower[draw], upper[draw]) for draw in draws]
