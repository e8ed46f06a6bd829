"""Pose of one body in the frame of another, which contact at its nodes needs once a pair and step."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import borrowing_kernel
from blockshake.solvers.vectors import difference, dot, transposed_product


class Poses(NamedTuple):
    """Poses now and a step earlier, world frame.

    ``position``, ``position_before`` (n_bodies, 3) [m]; ``rotation``, ``rotation_before`` (n_bodies, 3, 3),
    body to world.
    """

    position: np.ndarray
    rotation: np.ndarray
    position_before: np.ndarray
    rotation_before: np.ndarray


@borrowing_kernel
def keep_poses(poses):
    """Make the poses now those of the step before."""
    for body in range(poses.position.shape[0]):
        for i in range(3):
            poses.position_before[body, i] = poses.position[body, i]
            for j in range(3):
                poses.rotation_before[body, i, j] = poses.rotation[body, i, j]


@borrowing_kernel
def relative_pose_into(position, rotation, offset, pair, shift, side, R, d):
    """Pose of one body of a pair in the frame of the other's shape, whose origin is the shape's centroid.

    The owner of ``side`` 0 is the pair's first body. Its axes are ``R[side]`` (3, 3), its mass centre is ``d[side]``
    (3,); ``offset`` as in `Surfaces`, ``shift`` (3,) as in `NearPairs`.
    """
    owner, other = pair[side], pair[1 - side]
    away = transposed_product(rotation[other], difference(position[owner], position[other]))
    for i in range(3):
        for j in range(3):
            R[side, i, j] = (
                rotation[other, 0, i] * rotation[owner, 0, j]
                + rotation[other, 1, i] * rotation[owner, 1, j]
                + rotation[other, 2, i] * rotation[owner, 2, j]
            )
        d[side, i] = away[i] + offset[other, i]
        d[side, i] += shift[i] if side == 0 else -dot(R[1, i], shift)
