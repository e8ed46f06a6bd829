"""A sensor fault that was found, and the test of an estimate against its tolerance."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

MOST_MISFIT = 0.5  # of the misfit that taking an exchange back may leave


class Level(NamedTuple):
    """Chance of any finding on a campaign of faultless sensors, shared evenly by a number of hypotheses."""

    chance: float
    hypotheses: int


@dataclass(frozen=True)
class Finding:
    """One sensor fault."""

    effect: str  # that the fault counts as
    # of str; markers, channels or displacement transducers; ``("optical clock",)`` and ``("optical frame",)``
    # for faults of all markers; of an exchange of axes and of a polarity the marker and its axes
    where: tuple
    quantity: str  # kind of the fault, of `blockshake.parity.kinds.registry.KINDS`
    # estimate, covariance: float64 (n,), (n, n); in the units of the kind; n is 3 for a vector in the
    # inertial or body frame, 0 without an estimate
    estimate: np.ndarray
    covariance: np.ndarray
    # chance of such a reading with a sensor within its tolerance, times the number of hypotheses looked at
    p: float
    tests: tuple  # of str; names of the tests it holds for

    @property
    def standard_error(self):
        """For each component, float64 array, shape (n,)."""
        return np.sqrt(np.diagonal(self.covariance))

    def as_json(self):
        """JSON-like values of the finding."""
        arrays = {name: np.asarray(getattr(self, name)).tolist() for name in ("estimate", "covariance")}
        return vars(self) | arrays | {"p": float(self.p)}

    @classmethod
    def from_json(cls, values):
        """Read a finding from the values of `as_json`."""
        tuples = {name: tuple(values[name]) for name in ("where", "tests")}
        arrays = {name: np.array(values[name], dtype=float) for name in ("estimate", "covariance")}
        return cls(**values | tuples | arrays)


def chance_within(estimate, covariance, tolerance, freedom=np.inf):
    """Largest chance of an estimate as far out as this one while the truth is within the tolerance.

    Parameters
    ----------
    estimate, covariance : float64 arrays, shapes (n,), (n, n)
    tolerance : float
        Radius of the ball about zero that is no fault, in the estimate's unit.
    freedom : float
        Degrees of freedom behind the covariance.

    Notes
    -----
    The squared distance ``min (x - e)' C^-1 (x - e)`` of the estimate x to the ball ``|e| <= tolerance`` is at most
    the distance to the truth, whose distribution is chi-square (F with finite freedom): an upper bound of the
    chance for every truth in the ball. Components that were not observed have a large variance and add nothing.
    """
    size = len(estimate)
    if np.linalg.norm(estimate) <= tolerance:
        return 1.0
    variance, axes = np.linalg.eigh(covariance)
    along = axes.T @ estimate

    def nearest(multiplier):
        return along / (1.0 + multiplier * variance)

    def outside(multiplier):
        return np.linalg.norm(nearest(multiplier)) - tolerance

    largest = (np.linalg.norm(estimate) / tolerance) / variance.min()
    distance = ((along - nearest(scipy.optimize.brentq(outside, 0.0, largest))) ** 2 / variance).sum()
    chi2, f = scipy.stats.chi2, scipy.stats.f
    return float(chi2.sf(distance, size) if np.isinf(freedom) else f.sf(distance / size, size, freedom))


def chance_of_misfit(before, after, variance):
    """Bound the chance that an exchange which did not happen lowers the misfit as much as this one does.

    Parameters
    ----------
    before, after : float
        Sums of squared misfits as read, and with the exchange taken back.
    variance : float
        Of an independent value, times the number of values that depend on each other.

    Returns
    -------
    float
        1 where taking back leaves more than half of the misfit.

    Notes
    -----
    A wrong hypothesis beats the true one by a ratio L of likelihoods with a chance of at most 1 / L.
    """
    return 1.0 if after > MOST_MISFIT * before else float(np.exp(-(before - after) / (2.0 * variance)))
