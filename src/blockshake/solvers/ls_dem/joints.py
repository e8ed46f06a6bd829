"""Pairs of bodies that have come near each other, and what their joints remember."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import kernel


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


@kernel
def no_joints():
    """Joints before any body came near another."""
    return NearPairs(
        np.empty((0, 2), np.int64), np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0),
        np.empty(0, np.bool_),
    )  # fmt: skip


@kernel
def find_joint(joints, a, b):
    """Row of a pair, -1 where it never came near."""
    for joint in range(joints.slip.size):
        if joints.pair[joint, 0] == a and joints.pair[joint, 1] == b:
            return joint
    return -1


@kernel
def add_joints(joints, pairs):
    """Joints with further pairs, which have no shift, force, slip or touch."""
    n, more = joints.slip.size, pairs.shape[0]
    new = NearPairs(
        np.empty((n + more, 2), np.int64), np.zeros((n + more, 3)), np.zeros((n + more, 3)), np.zeros(n + more),
        np.zeros(n + more), np.zeros(n + more, np.bool_),
    )  # fmt: skip
    new.pair[:n], new.pair[n:], new.shift[:n] = joints.pair, pairs, joints.shift
    new.force[:n], new.slip[:n], new.slip_rate[:n] = joints.force, joints.slip, joints.slip_rate
    new.touched[:n] = joints.touched
    return new
