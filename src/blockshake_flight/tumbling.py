"""Rotation of a body in flight: the angular momentum is kept, the spin is not."""

from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.dynamics.free_turning import free_turning

_NEWTON_STEPS = 3  # of Gauss and Newton
_CHANGE = 1e-4  # rad; share of the momentum: by which the path's derivative is found
_ROUND = 1e-9  # of the inertia, within which it is alike about all axes


@lru_cache(maxsize=4096)
def tumbling(tracked, arc):
    """Rotations of a flight, and the angular momentum that is the same at all of them.

    Parameters
    ----------
    tracked : TrackedCampaign
    arc : Arc

    Returns
    -------
    scipy.spatial.transform.Rotation, float64 array, shape (3,)
        Rotations at n instants, body to world; angular momentum about the mass centre, world frame [kg m2/s].

    Notes
    -----
    Euler's equations without a moment: ``omega = R I^-1 R' L`` with L constant. L is first the mean of the momenta
    between neighbouring readings, weighted as in the slope of a line, so that no turn is too large; then start and
    momentum are those that leave the least, by the path's own derivative.
    """
    inertia = tracked.structure.inertia[tracked.body]
    read = Rotation.from_matrix(arc.rotation)
    between = read[:-1].inv() * read[1:]  # in body axes
    rates = between.as_rotvec() / np.diff(arc.time)[:, None]
    middle = read[:-1] * Rotation.from_rotvec(0.5 * between.as_rotvec())
    number = np.arange(1, len(arc.time))
    momentum = np.average(middle.apply(rates @ inertia), axis=0, weights=number * (len(arc.time) - number))
    start = read[0]
    small = _CHANGE * np.diag([1.0] * 3 + [np.linalg.norm(momentum) + 1e-12] * 3)
    for _ in range(_NEWTON_STEPS):
        changes = np.concatenate([np.zeros((1, 6)), small])
        starts = Rotation.from_rotvec(changes[:, :3]) * start
        paths = _turned(starts, momentum + changes[:, 3:], inertia, arc.time)
        left = (read * paths[0].inv()).as_rotvec().ravel()
        design = np.stack([(path * paths[0].inv()).as_rotvec().ravel() for path in paths[1:]], axis=1)
        change = np.linalg.lstsq(design, left, rcond=None)[0] @ small
        start, momentum = Rotation.from_rotvec(change[:3]) * start, momentum + change[3:]
    return _turned(Rotation.concatenate([start]), momentum[None], inertia, arc.time)[0], momentum


def spins(tracked, path, momentum):
    """Angular velocities of rotations with an angular momentum, (n, 3), world frame [rad/s]."""
    inverse = np.linalg.inv(tracked.structure.inertia[tracked.body])
    return _spins(path, np.tile(momentum, (len(path), 1)), inverse)


def _turned(starts, momenta, inertia, time):
    """Rotations at the times from several starts with their momenta, by the midpoint rule: a list of paths."""
    inverse = np.linalg.inv(inertia)
    if np.ptp(np.linalg.eigvalsh(inertia)) < _ROUND * np.trace(inertia):  # the spin is kept
        return [
            Rotation.from_rotvec(time[:, None] * (inverse @ momentum)) * start
            for start, momentum in zip(starts, momenta, strict=True)
        ]
    paths = free_turning(starts.as_quat(scalar_first=True), momenta, inverse, time)
    return [Rotation.from_quat(path, scalar_first=True) for path in paths]


def _spins(turned, momenta, inverse):
    return turned.apply(turned.inv().apply(momenta) @ inverse)
