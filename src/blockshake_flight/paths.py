"""Paths that causes make of a flight: what each adds to the tracked positions, per unit of its size."""

import numpy as np
from scipy.integrate import cumulative_trapezoid

from blockshake.geometry.schema import CREEP


def fallen(arc, gravity):
    """Path of a free fall, (n, 3) [m]."""
    return 0.5 * arc.time[:, None] ** 2 * np.asarray(gravity)


def longer(arc, gravity):
    """Lengths that are read too long by a share of themselves; place and speed at the start go with them."""
    return fallen(arc, gravity)[:, None]


def pushed(arc):
    """Steady accelerations along the three axes, (n, 3 of the force, 3)."""
    return 0.5 * arc.time[:, None, None] ** 2 * np.eye(3)


def off_centre(arc):
    """Mass centre off the tracked centroid along the three axes of the body, (n, 3 of the offset, 3).

    The mass centre m falls; the centroid is at ``m - R d`` for the offset d in body axes.
    """
    return -np.swapaxes(arc.rotation, 1, 2)


def dragged(arc):
    """Deceleration in proportion to the velocity, per 1/s, (n, 1, 3)."""
    return _twice(arc, -arc.smooth()[1])


def dragged_by_square(arc):
    """Deceleration in proportion to the square of the speed, per 1/m, (n, 1, 3)."""
    velocity = arc.smooth()[1]
    return _twice(arc, -velocity * np.linalg.norm(velocity, axis=1, keepdims=True))


def dragged_dry(arc):
    """Steady deceleration against the velocity, per m/s2, (n, 1, 3)."""
    velocity = arc.smooth()[1]
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    return _twice(arc, -velocity / np.maximum(speed, CREEP) * np.tanh(speed / CREEP))


def _twice(arc, acceleration):
    """Path of an acceleration from rest, (n, 1, 3)."""
    speed = cumulative_trapezoid(acceleration, arc.time, axis=0, initial=0.0)
    return cumulative_trapezoid(speed, arc.time, axis=0, initial=0.0)[:, None]
