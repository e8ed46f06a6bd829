"""When a stack counts as collapsed."""

import numpy as np

from blockshake.jit import kernel

_COS_HALF_TILT = np.cos(np.pi / 8.0)  # half of 45 degrees


def supported_bodies(structure):
    """Free bodies that touch something at the start: bool array, shape (n_bodies,).

    A body in flight at the start has nothing to fall from.
    """
    return structure.touching.any(axis=1) & ~structure.driven


def drop_limits(structure):
    """Fall of each body that counts as collapse: half its smallest extent [m], shape (n_bodies,)."""
    return np.array([0.5 * np.ptp(structure.solid(body).vertices, axis=0).min() for body in range(len(structure.mass))])


@kernel
def find_collapsed(bodies, state, supported, drop_limit):
    """First supported body that has overturned or fallen, -1 when all stand.

    Overturned: tilted (or turned) by more than 45 degrees from its pose in the structure file.
    Fallen: its mass centre has sunk by more than its ``drop_limit``, seen from the first driven
    body.
    """
    ground = 0.0
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            ground = state.position[body, 2] - bodies.home[body, 2]
            break
    for body in range(bodies.mass.size):
        if not supported[body]:
            continue
        dot = 0.0
        for part in range(4):
            dot += state.orientation[body, part] * bodies.home_orientation[body, part]
        sunk = bodies.home[body, 2] + ground - state.position[body, 2]
        if abs(dot) < _COS_HALF_TILT or sunk > drop_limit[body]:
            return body
    return -1
