"""Parameters of an effect with 90 % intervals, from the posterior of its size."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.inference.decision import ParameterEstimate
from blockshake.effects.registry import EFFECTS

_INTERVAL_SHARE = 0.9  # of the posterior, in an interval


def calibrated_weights(sizes, weights, error):
    """Posterior of a size as wide as its errors are where the truth is known.

    Parameters
    ----------
    sizes, weights : float64 array, shape (n_sizes,)
        As of `Scores`.
    error : float
        Root mean square of the posterior mean's error over the library's own cases, as of `size_error`.

    Returns
    -------
    float64 array, shape (n_sizes,)
        Gaussian about the posterior's mean, with the larger of both standard deviations, cut off at the ends of the
        library's sizes. The likelihood alone is too sure: what features miss together it takes for separate evidence.
    """
    mean = float(sizes @ weights)
    own = float(np.sqrt((sizes - mean) ** 2 @ weights))
    spread = max(own, error, 0.5 * float(np.diff(sizes).max()))
    wide = np.exp(-0.5 * ((sizes - mean) / spread) ** 2)
    return wide / wide.sum()


class SizeInterval(NamedTuple):
    """Median of a size's posterior, and the ends of the interval about it."""

    estimate: float
    lower: float
    upper: float


def size_interval(sizes, weights, share):
    """`SizeInterval`: median of the posterior, and the interval about it that holds a share of it, in (0, 1].

    ``sizes`` and ``weights`` (n_sizes,) as of `Scores`.
    """
    # up to the middle of each size's own share
    below = (np.cumsum(weights) - 0.5 * weights) / np.sum(weights)
    levels = (0.5, 0.5 * (1.0 - share), 0.5 * (1.0 + share))
    kept = np.concatenate([[True], np.diff(below) > 0.0])
    return SizeInterval(*(float(np.interp(level, below[kept], sizes[kept])) for level in levels))


def parameter_estimates(effect, sizes, weights):
    """Estimates of all parameters of an effect, with 90 % intervals.

    Parameters
    ----------
    effect : str
    sizes, weights : float64 array, shape (n_sizes,)
        As of `size_interval`; sizes in units of the visible one.

    Returns
    -------
    dict of str to ParameterEstimate
        By parameter. Of a parameter that only the prior tells, the middle nine tenths of the prior are given.
    """
    first, *others = EFFECTS[effect].parameters
    values = [
        first.null + size * (first.visible - first.null)
        for size in size_interval(sizes, weights, _INTERVAL_SHARE)
    ]
    found = {
        first.name: ParameterEstimate(
            estimate=values[0], lower=min(values), upper=max(values), unit=first.unit, informed=True
        )
    }
    for item in others:
        width = item.upper - item.lower
        found[item.name] = ParameterEstimate(
            estimate=item.lower + 0.5 * width,
            lower=item.lower + 0.05 * width,
            upper=item.upper - 0.05 * width,
            unit=item.unit,
            informed=False,
        )
    return found
