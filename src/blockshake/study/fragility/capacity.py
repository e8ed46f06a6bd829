"""Capacities known to lie between two levels of intensity, and the lognormal distribution that fits them."""

from typing import NamedTuple

import numpy as np
import scipy
from scipy.special import ndtr, ndtri

from blockshake.statistics.intervals import CONFIDENCE

_SHARPEST, _WIDEST = 1e-6, 10.0  # dispersions that stand for none and for any [1]
# the grid of limits: logarithms beyond the levels, its smallest dispersion, and its points
_BEYOND, _NARROWEST, _MEDIANS, _DISPERSIONS = 2.0, 1e-3, 801, 201
_NEVER = 1e-300  # probability that stands for none [1]


class Capacity(NamedTuple):
    """Lognormal capacity: median, in the unit of the levels, and standard deviation of the logarithm [1]."""

    median: float
    dispersion: float

    def probability(self, level):
        """Probability of a capacity below a level, or levels [1]."""
        return ndtr((np.log(level) - np.log(self.median)) / np.maximum(self.dispersion, _SHARPEST))

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
    low, high, counts, ends = _logarithms(lower, upper)
    between = np.isfinite(low) & np.isfinite(high)
    middle = 0.5 * (low[between] + high[between]) if between.any() else ends

    def unlikely(parameters):
        return -counts @ _likelihood(low, high, parameters[0], np.exp(parameters[1]))

    start = np.mean(middle), np.log(0.5 * np.ptp(ends))
    limits = [(ends.min(), ends.max()), (np.log(_SHARPEST), np.log(_WIDEST))]
    answer = scipy.optimize.minimize(
        unlikely, start, method="Nelder-Mead", bounds=limits, options={"xatol": 1e-6, "fatol": 1e-9}
    )
    return Capacity(float(np.exp(answer.x[0])), float(np.exp(answer.x[1])))


def estimate_capacity(lower, upper, weight=1.0):
    """`fit_capacity`, the `Capacity` of many values that are as likely as 95 % allows, and the function that gives the
    limits of a function of these along its last axis.

    ``weight``: share of the capacities that are independent of each other, by which the limits widen [1]. NaN stands
    for all where no dispersion is known: all capacities then lie between two levels.
    """
    fitted, unknown = fit_capacity(lower, upper), Capacity(np.full(1, np.nan), np.full(1, np.nan))
    likely = likely_capacities(lower, upper, weight) if fitted.dispersion > 0.0 else unknown
    return fitted, likely, lambda values: np.stack([values.min(axis=-1), values.max(axis=-1)])


def likely_capacities(lower, upper, weight=1.0):
    """`Capacity` of many values, of which those of a function of it span the limits of 95 % of that function.

    Parameters
    ----------
    lower, upper
        Bounds as in `fit_capacity`, which finds a dispersion above 0 in them.
    weight : float
        A capacity in the likelihood [1].

    Returns
    -------
    Capacity
        float64 arrays, shape (n,): all on a grid whose likelihood is not too small; NaN where they reach its end, so
        that the data leave the capacity without limits. The smallest dispersion stands for none.

    Notes
    -----
    Profile likelihood (Venzon and Moolgavkar 1988). The ratio is that which gives Student's limits of the median of
    capacities that are known exactly, ``n ln(1 + t^2 / (n - 1))``, and not its limit of many samples. A bootstrap held
    the dispersion in 79 of 100 cases of 20 samples.
    """
    low, high, counts, ends = _logarithms(lower, upper)
    counts = weight * counts
    middle = np.linspace(ends.min() - _BEYOND, ends.max() + _BEYOND, _MEDIANS)[:, None]
    spread = np.geomspace(_NARROWEST, _WIDEST, _DISPERSIONS)
    likelihood = np.zeros((_MEDIANS, _DISPERSIONS))
    for count, *bounds in zip(counts, low, high, strict=True):
        likelihood += count * _likelihood(*bounds, middle, spread)
    size = counts.sum()
    least = 0.5 * size * np.log1p(scipy.stats.t.ppf(0.5 + 0.5 * CONFIDENCE, size - 1) ** 2 / (size - 1))
    likely = likelihood >= likelihood.max() - least
    if likely[[0, -1]].any() or likely[:, -1].any():
        return Capacity(np.full(1, np.nan), np.full(1, np.nan))
    median, dispersion = np.nonzero(likely)
    spread[0] = 0.0
    return Capacity(np.exp(middle[median, 0]), spread[dispersion])


def _logarithms(lower, upper):
    """Logarithms of the different pairs of bounds, how often each pair stands, and those logarithms that are finite."""
    bounds, counts = np.unique(np.column_stack([lower, upper]), axis=0, return_counts=True)
    with np.errstate(divide="ignore"):
        low, high = np.log(bounds).T
    return low, high, counts, np.concatenate([low[np.isfinite(low)], high[np.isfinite(high)]])


def _likelihood(low, high, middle, spread):
    """Logarithm of the chance of a capacity between two bounds; all of them logarithms."""
    share = ndtr((high - middle) / spread) - ndtr((low - middle) / spread)
    return np.log(np.maximum(share, _NEVER))
