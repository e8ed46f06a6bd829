"""Pose of one body in the frame of another, which contact at its nodes needs once a pair and step."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import borrowing_kernel


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
def relative_pose_into(position, rotation, offset, owner, other, side, R, d):
    """Pose of ``owner`` in the frame of the shape of ``other``, whose origin is the shape's centroid.

    Its axes ``R[side]`` (3, 3) and its mass centre ``d[side]`` (3,); ``offset`` as in `Surfaces`.
    """
    for i in range(3):
        for j in range(3):
            R[side, i, j] = (
                rotation[other, 0, i] * rotation[owner, 0, j]
                + rotation[other, 1, i] * rotation[owner, 1, j]
                + rotation[other, 2, i] * rotation[owner, 2, j]
            )
        d[side, i] = (
            rotation[other, 0, i] * (position[owner, 0] - position[other, 0])
            + rotation[other, 1, i] * (position[owner, 1] - position[other, 1])
            + rotation[other, 2, i] * (position[owner, 2] - position[other, 2])
            + offset[other, i]
        )
