"""Rotation of a body in flight: the angular momentum is kept, the spin is not."""

from functools import lru_cache

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.spatial.transform import Rotation

_ROUNDS = 4  # of Gauss and Newton
_STEPS = 4  # between two readings


@lru_cache(maxsize=4096)
def tumbling(posed, arc):
    """Rotations of a flight, and the angular momentum that is the same at all of them.

    Parameters
    ----------
    posed : PosedCampaign
    arc : Arc

    Returns
    -------
    scipy.spatial.transform.Rotation, float64 array, shape (3,)
        Of length n, body to world; angular momentum about the mass centre, world frame [kg m2/s].

    Notes
    -----
    Euler's equations without a moment: ``omega = R I^-1 R' L`` with L constant. L is first the mean of the momenta
    between neighbouring readings, weighted as in the slope of a line, so that no turn is too large; then start and
    momentum are those that leave the least, by the path's own derivative.
    """
    inertia = posed.structure.inertia[posed.body]
    read = Rotation.from_matrix(arc.rotation)
    between = read[:-1].inv() * read[1:]  # in body axes
    rates = between.as_rotvec() / np.diff(arc.time)[:, None]
    middle = read[:-1] * Rotation.from_rotvec(0.5 * between.as_rotvec())
    number = np.arange(1, len(arc.time))
    momentum = np.average(middle.apply(rates @ inertia), axis=0, weights=number * (len(arc.time) - number))
    start = read[0]
    for _ in range(_ROUNDS):
        path = _turned(start, momentum, np.linalg.inv(inertia), arc.time)
        left = (read * path.inv()).as_rotvec()
        per_momentum = cumulative_trapezoid(_mobilities(path, inertia), arc.time, axis=0, initial=0.0)
        design = np.concatenate([np.broadcast_to(np.eye(3), per_momentum.shape), per_momentum], axis=2)
        change, *_ = np.linalg.lstsq(design.reshape(-1, 6), left.ravel(), rcond=None)
        start, momentum = Rotation.from_rotvec(change[:3]) * start, momentum + change[3:]
    return _turned(start, momentum, np.linalg.inv(inertia), arc.time), momentum


def spins(posed, path, momentum):
    """Angular velocities of rotations with an angular momentum, (n, 3), world frame [rad/s]."""
    return _mobilities(path, posed.structure.inertia[posed.body]) @ momentum


def _mobilities(path, inertia):
    turned = path.as_matrix()
    return turned @ np.linalg.inv(inertia) @ np.swapaxes(turned, 1, 2)


def _turned(start, momentum, inverse, time):
    """Rotations from a start on, by the midpoint rule."""
    turned, found = start.as_matrix(), [start.as_matrix()]
    for step in np.diff(time):
        for _ in range(_STEPS):
            half = _rotated(turned @ (inverse @ (momentum @ turned)) * (0.5 * step / _STEPS)) @ turned
            turned = _rotated(half @ (inverse @ (momentum @ half)) * (step / _STEPS)) @ turned
        found.append(turned)
    return Rotation.from_matrix(np.array(found))


def _rotated(vector):
    """Rotation matrix of a rotation vector (Rodrigues 1840)."""
    angle = float(np.sqrt(vector @ vector))
    x, y, z = vector
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    return np.eye(3) + first * skew + second * (skew @ skew)
