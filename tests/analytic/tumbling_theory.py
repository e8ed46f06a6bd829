"""Free flight of an asymmetric top: Euler's equations in elliptic functions, and the brick that is thrown."""

import numpy as np
from scipy.special import ellipj

SPIN = np.array([0.4, 0.0, 9.0])  # rad/s in body axes, about the axis of the largest inertia, nearly
EDGES = {"brick": {"box": [2.4, 1.6, 0.8]}}


def thrown():
    """Body of a structure file."""
    return {
        "name": "b", "shape": "brick", "position": [0.0, 0.0, 50.0],
        "velocity": [1.0, 0.5, 3.0], "angular_velocity": list(SPIN),
    }  # fmt: skip


def elliptic(inertia, spin, t):
    """Angular velocity in body axes [rad/s], (n, 3); inertia ascending, spin about the second axis zero at t = 0.

    Landau & Lifshitz, Mechanics, section 37.
    """
    a, b, c = inertia
    twice_energy, square = (inertia * spin**2).sum(), ((inertia * spin) ** 2).sum()
    assert square > twice_energy * b
    rate = np.sqrt((c - b) * (square - twice_energy * a) / (a * b * c))
    m = (b - a) * (twice_energy * c - square) / ((c - b) * (square - twice_energy * a))
    sn, cn, dn, _ = ellipj(rate * t, m)
    return np.column_stack(
        [
            np.sqrt((twice_energy * c - square) / (a * (c - a))) * cn,
            np.sqrt((twice_energy * c - square) / (b * (c - b))) * sn,
            np.sqrt((square - twice_energy * a) / (c * (c - a))) * dn,
        ]
    )
