"""A sensor fault that was found, and the test of an estimate against its tolerance."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2, f

# Kinds of faults, each by the quantity that is estimated, and the effects of the registry that they count as; in the
# order in which they are taken out of readings.
EFFECTS = {
    "swap": "channel-swap",
    "axes": "channel-swap",
    "polarity": "channel-swap",
    "slip": "sensor-drift",
    "drift": "sensor-drift",
    "gain": "sensor-gain",
    "place": "marker-offset",
    "reference place": "marker-offset",
    "lag": "clock-lag",
    "skew": "clock-lag",
    "range": "sensor-saturation",
}


class Level(NamedTuple):
    """Chance of any finding on a campaign of sound sensors, shared evenly by a number of hypotheses."""

    chance: float
    hypotheses: int


@dataclass(frozen=True)
class Finding:
    """One sensor fault.

    Attributes
    ----------
    effect : str
        Of the registry, as of `EFFECTS`.
    where : tuple of str
        Markers, channels or displacement transducers; ``("optical clock",)`` and ``("optical frame",)`` for faults of
        all markers.
    quantity : str
        Estimated quantity: ``gain`` (reading over truth, less 1) [1], ``place`` (where the marker is less where it is
        said to be, body frame) [m], ``drift`` [m/s or m/s3], ``lag`` [s], ``skew`` [1], ``range`` (largest reading);
        of a displacement transducer ``place`` of its end at the body, ``reference place`` of the other end, and
        ``slip`` (step of the reading [m] and its time [s]); and without an estimate ``swap``, ``axes`` and
        ``polarity``.
    estimate, covariance : float64 arrays, shapes (n,), (n, n)
        n is 3 for a vector in the inertial or body frame.
    p : float
        Chance of such a reading with a sensor within its tolerance, times the number of hypotheses looked at.
    tests : tuple of str
        Names of the tests it holds for.
    rivals : tuple of (effect, where, quantity)
        Faults that explain the same readings nearly as well.
    """

    effect: str
    where: tuple
    quantity: str
    estimate: np.ndarray
    covariance: np.ndarray
    p: float
    tests: tuple
    rivals: tuple = ()

    @classmethod
    def of(cls, quantity, where, p, tests, estimate=(), covariance=None, rivals=()):
        """The finding of a kind; without an estimate where nothing is to be estimated. p is 1 at most."""
        estimate = np.asarray(estimate, dtype=float)
        covariance = np.zeros((len(estimate),) * 2) if covariance is None else covariance
        return cls(
            EFFECTS[quantity], where, quantity, estimate, covariance, min(p, 1.0), tuple(tests), rivals
        )

    @property
    def standard_error(self):
        """Of each component, float64 array, shape (n,)."""
        return np.sqrt(np.diagonal(self.covariance))

    def as_json(self):
        """As JSON-like values."""
        arrays = {name: np.asarray(getattr(self, name)).tolist() for name in ("estimate", "covariance")}
        return vars(self) | arrays | {"p": float(self.p)}

    @classmethod
    def from_json(cls, values):
        """The finding of such values."""
        tuples = {name: tuple(values[name]) for name in ("where", "tests")}
        rivals = tuple((effect, tuple(where), quantity) for effect, where, quantity in values["rivals"])
        arrays = {name: np.array(values[name], dtype=float) for name in ("estimate", "covariance")}
        return cls(**values | tuples | arrays | {"rivals": rivals})


def chance_within(estimate, covariance, tolerance, freedom=np.inf):
    """Largest chance of an estimate as far out as this one while the truth is within the tolerance.

    Parameters
    ----------
    estimate, covariance : float64 arrays, shapes (n,), (n, n)
    tolerance : float
        Radius of the ball about zero that is no fault, in the estimate's unit.
    freedom : float
        Degrees of freedom behind the covariance.

    Returns
    -------
    float

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

    if tolerance == 0.0:
        distance = (along**2 / variance).sum()
    else:
        largest = (np.linalg.norm(estimate) / tolerance) / variance.min()
        distance = ((along - nearest(brentq(outside, 0.0, largest))) ** 2 / variance).sum()
    return float(chi2.sf(distance, size) if np.isinf(freedom) else f.sf(distance / size, size, freedom))
