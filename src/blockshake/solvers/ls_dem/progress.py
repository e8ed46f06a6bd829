"""State of an LS-DEM run and of its joints between two steps: enough to stop it there and to go on from there."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel
from blockshake.solvers.ls_dem.contact.relative_pose import Poses, poses_at_rest

# Entry of ``clock`` after `STEP` and `NEXT_RECORD` of `blockshake.solvers.record`
SEARCHES = 2
# Entries of ``audit`` [J]
FRICTION_HEAT, MOST_FRICTION_HEAT, DASHPOT_HEAT, INPUT_WORK = 0, 1, 2, 3


class NearPairs(NamedTuple):
    """Joints in the order in which their bodies came near; they outlast the lists of near nodes.

    ``pair`` int64 (n_joints, 2): bodies, the lower index first. ``shift`` (n_joints, 3): where contact sees the first
    body from where it is, frame of the second, all through a run: what they overlapped by as they were laid [m].
    ``force`` (n_joints, 3): on the second body at the last step, world frame [N]. ``slip`` (n_joints,): made so far,
    either way [m]; ``slip_rate`` (n_joints,): at the last step [m/s]. ``touched`` bool (n_joints,).
    """

    pair: np.ndarray
    shift: np.ndarray
    force: np.ndarray
    slip: np.ndarray
    slip_rate: np.ndarray
    touched: np.ndarray


@inner_kernel
def no_joints():
    """Joints before any body came near another."""
    return NearPairs(
        np.empty((0, 2), np.int64), np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0),
        np.empty(0, np.bool_),
    )  # fmt: skip


@inner_kernel
def find_joint(joints, a, b):
    """Row of the joint of two bodies, -1 where they never came near each other."""
    for joint in range(joints.slip.size):
        if joints.pair[joint, 0] == a and joints.pair[joint, 1] == b:
            return joint
    return -1


@inner_kernel
def add_joints(joints, pairs):
    """Joints, followed by those of further pairs, which have no shift, force, slip or touch yet."""
    n, more = joints.slip.size, pairs.shape[0]
    new = NearPairs(
        np.empty((n + more, 2), np.int64), np.zeros((n + more, 3)), np.zeros((n + more, 3)), np.zeros(n + more),
        np.zeros(n + more), np.zeros(n + more, np.bool_),
    )  # fmt: skip
    copy_into(pairs, new.pair[n:])
    copy_into(joints.pair, new.pair)
    copy_into(joints.shift, new.shift)
    copy_into(joints.force, new.force)
    copy_into(joints.slip, new.slip)
    copy_into(joints.slip_rate, new.slip_rate)
    copy_into(joints.touched, new.touched)
    return new


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
        poses=poses_at_rest(state.position, rotation),
        half_velocity=state.velocity.copy(),
        half_momentum=momentum,
        driven_force=np.zeros((n_bodies, 3)),
        driven_moment=np.zeros((n_bodies, 3)),
        ground=np.zeros(4),
        clock=np.zeros(3, dtype=np.int64),
        audit=np.zeros(4),
        started=started,
    )
