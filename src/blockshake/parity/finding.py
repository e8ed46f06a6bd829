"""A sensor fault that was found, and the test of an estimate against its tolerance."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2, f


@dataclass(frozen=True)
class Finding:
    """One sensor fault.

    Attributes
    ----------
    effect : str
        Registry name: ``sensor-gain``, ``marker-offset``, ``sensor-drift``, ``channel-swap``, ``clock-lag`` or
        ``sensor-saturation``.
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
