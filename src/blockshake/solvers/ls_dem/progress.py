"""State of an LS-DEM run between two steps: enough to stop it there and to go on as if it had not stopped."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.ls_dem.contact.relative_pose import Poses

# Entry of ``clock`` after `STEP` and `NEXT_RECORD` of `blockshake.solvers.status`
SEARCHES = 2
# Entries of ``audit`` [J]
FRICTION_HEAT, MOST_FRICTION_HEAT, DASHPOT_HEAT, INPUT_WORK = 0, 1, 2, 3


class LeapfrogProgress(NamedTuple):
    """State of a run between two steps, changed in place by kernels.

    ``state``: at the last step. ``poses``: its positions are those of ``state``. ``half_velocity``,
    ``half_momentum`` (n_bodies, 3): half a step before the next step, the latter of rotation, world
    frame [m/s, kg m2/s]. ``driven_force``, ``driven_moment`` (n_bodies, 3): on driven bodies at the last
    step [N, N m]. ``ground`` (4,): displacement and pitch at the last step [m, rad]. ``clock`` int64 (3,):
    next step, next record, searches so far. ``audit`` (4,) [J]. ``started`` (3,): from `settled_start`.
    """

    state: State
    poses: Poses
    half_velocity: np.ndarray
    half_momentum: np.ndarray
    driven_force: np.ndarray
    driven_moment: np.ndarray
    ground: np.ndarray
    clock: np.ndarray
    audit: np.ndarray
    started: np.ndarray


def start_progress(bodies, state, started):
    """Progress before the first step."""
    n_bodies = len(bodies.mass)
    rotation = np.ascontiguousarray(rotation_matrices(state.orientation))
    spin_frame = np.einsum("bji,bj->bi", rotation, state.angular_velocity)
    momentum = np.einsum("bij,bjk,bk->bi", rotation, bodies.inertia, spin_frame)
    momentum[bodies.driven] = 0.0
    return LeapfrogProgress(
        state=state,
        poses=Poses(state.position, rotation, state.position.copy(), rotation.copy()),
        half_velocity=state.velocity.copy(),
        half_momentum=momentum,
        driven_force=np.zeros((n_bodies, 3)),
        driven_moment=np.zeros((n_bodies, 3)),
        ground=np.zeros(4),
        clock=np.zeros(3, dtype=np.int64),
        audit=np.zeros(4),
        started=started,
    )
