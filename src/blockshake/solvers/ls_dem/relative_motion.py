"""How one body moves in the frame of another: what contact at its nodes needs, once a pair and step."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import kernel


class Kinematics(NamedTuple):
    """What contact needs of the motion.

    ``position`` (n_bodies, 3) and ``rotation`` (n_bodies, 3, 3), body to world, at the step;
    ``position_before``, ``rotation_before``: a step earlier, from where the shear springs stretch;
    ``velocity``, ``spin`` (n_bodies, 3): at the step, for the dashpots. World frame.
    """

    position: np.ndarray
    rotation: np.ndarray
    position_before: np.ndarray
    rotation_before: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


@kernel
def relative_frame_into(kinematics, owner, other, turned, R, frame):
    """Motion of ``owner`` in the body frame of ``other``.

    ``R`` (3, 3): owner's axes in the other's. ``frame`` (7, 3), rows: 0 owner's mass centre;
    1 and 2 relative velocity field ``row 1 + row 2 x q`` at the step, where q is a position in
    the other's frame; 3 to 6 what changed since the step before, of the mass centre and of ``R``.
    ``turned`` (3, 3) is workspace.

    The change is the difference of two poses and not a velocity times the step: taken with the
    lever arms of the step's end, the latter would creep by ``dt / 2`` times the centripetal acceleration.
    """
    before = kinematics.position_before, kinematics.rotation_before
    _relative_pose_into(before[0], before[1], owner, other, frame[4:7], frame[3])
    _relative_pose_into(kinematics.position, kinematics.rotation, owner, other, R, frame[0])
    for i in range(3):
        frame[3, i] = frame[0, i] - frame[3, i]
        for j in range(3):
            frame[4 + i, j] = R[i, j] - frame[4 + i, j]
    R_other, d = kinematics.rotation[other], frame[0]
    # owner's velocity difference, owner's spin and other's spin, all in the other's frame
    for i in range(3):
        turned[0, i] = turned[1, i] = turned[2, i] = 0.0
        for j in range(3):
            turned[0, i] += R_other[j, i] * (kinematics.velocity[owner, j] - kinematics.velocity[other, j])
            turned[1, i] += R_other[j, i] * kinematics.spin[owner, j]
            turned[2, i] += R_other[j, i] * kinematics.spin[other, j]
    v, w, u = turned[0], turned[1], turned[2]
    # v + w x (q - d) - u x q = (v - w x d) + (w - u) x q
    frame[1, 0] = v[0] - (w[1] * d[2] - w[2] * d[1])
    frame[1, 1] = v[1] - (w[2] * d[0] - w[0] * d[2])
    frame[1, 2] = v[2] - (w[0] * d[1] - w[1] * d[0])
    for i in range(3):
        frame[2, i] = w[i] - u[i]


@kernel
def _relative_pose_into(position, rotation, owner, other, R, d):
    """Axes ``R`` (3, 3) and mass centre ``d`` (3,) of ``owner`` in the body frame of ``other``."""
    R_owner, R_other = rotation[owner], rotation[other]
    for i in range(3):
        for j in range(3):
            R[i, j] = (
                R_other[0, i] * R_owner[0, j] + R_other[1, i] * R_owner[1, j] + R_other[2, i] * R_owner[2, j]
            )
        d[i] = 0.0
        for j in range(3):
            d[i] += R_other[j, i] * (position[owner, j] - position[other, j])
