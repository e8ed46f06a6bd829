"""Rotation of a free body: its angular momentum is kept, its spin is not."""

import numpy as np

from blockshake.geometry.rotations import rotation_rows, turned
from blockshake.jit import kernel, kernel_without_allocation

STEPS = 2  # between two times


@kernel
def free_turning(starts, momenta, inverse, time):
    """Rotations of free bodies, each with an angular momentum of its own, by the midpoint rule.

    Parameters
    ----------
    starts : float64 array, shape (n_bodies, 4)
        Unit quaternions (w, x, y, z) at the first time, body to world.
    momenta : float64 array, shape (n_bodies, 3)
        About the mass centre, world frame [kg m2/s].
    inverse : float64 array, shape (3, 3)
        Inverse of the inertia that all have, body frame [1/(kg m2)].
    time : float64 array, shape (n_times,)
        [s]

    Returns
    -------
    float64 array, shape (n_bodies, n_times, 4)
        Unit quaternions at the times.

    Notes
    -----
    Euler's equations without a moment: ``omega = R I^-1 R' L`` with L constant, in two steps between two times.
    """
    found = np.empty((starts.shape[0], time.size, 4))
    for body in range(starts.shape[0]):
        q, m = starts[body], (momenta[body, 0], momenta[body, 1], momenta[body, 2])
        now = (q[0], q[1], q[2], q[3])
        for place in range(time.size):
            if place > 0:
                h = (time[place] - time[place - 1]) / STEPS
                for _ in range(STEPS):
                    x, y, z = _spin(now, m, inverse)
                    half = turned(now[0], now[1], now[2], now[3], 0.5 * h * x, 0.5 * h * y, 0.5 * h * z)
                    x, y, z = _spin(half, m, inverse)
                    now = turned(now[0], now[1], now[2], now[3], h * x, h * y, h * z)
            for part in range(4):
                found[body, place, part] = now[part]
    return found


@kernel_without_allocation
def _spin(q, m, inverse):
    """Angular velocity [rad/s], world frame, at a rotation ``q`` with the angular momentum ``m``."""
    (a, b, c), (d, e, f), (g, h, i) = rotation_rows(q)
    x, y, z = a * m[0] + d * m[1] + g * m[2], b * m[0] + e * m[1] + h * m[2], c * m[0] + f * m[1] + i * m[2]
    u = inverse[0, 0] * x + inverse[0, 1] * y + inverse[0, 2] * z
    v = inverse[1, 0] * x + inverse[1, 1] * y + inverse[1, 2] * z
    w = inverse[2, 0] * x + inverse[2, 1] * y + inverse[2, 2] * z
    return a * u + b * v + c * w, d * u + e * v + f * w, g * u + h * v + i * w
