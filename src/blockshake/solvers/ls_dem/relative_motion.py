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
def relative_frame_into(kinematics, owner, other, side, turned, R, frame):
    """Motion of ``owner`` in the body frame of ``other``.

    ``R[side]`` (3, 3): owner's axes in the other's. ``frame[side]`` (7, 3), rows: 0 owner's mass
    centre; 1 and 2 relative velocity field ``row 1 + row 2 x q`` at the step, where q is a
    position in the other's frame; 3 to 6 what changed since the step before, of the mass centre
    and of ``R``. ``turned`` (3, 3) is workspace. Whole arrays and an index are passed because a
    slice costs more than what is done with it here.

    The change is the difference of two poses and not a velocity times the step: taken with the
    lever arms of the step's end, the latter would creep by ``dt / 2`` times the centripetal acceleration.
    """
    position, rotation = kinematics.position, kinematics.rotation
    velocity, spin = kinematics.velocity, kinematics.spin
    position_before, rotation_before = kinematics.position_before, kinematics.rotation_before
    for i in range(3):
        for j in range(3):
            now, before = 0.0, 0.0
            for k in range(3):
                now += rotation[other, k, i] * rotation[owner, k, j]
                before += rotation_before[other, k, i] * rotation_before[owner, k, j]
            R[side, i, j] = now
            frame[side, 4 + i, j] = now - before
        now, before = 0.0, 0.0
        # owner's velocity difference, owner's spin and other's spin, all in the other's frame
        v, w, u = 0.0, 0.0, 0.0
        for k in range(3):
            now += rotation[other, k, i] * (position[owner, k] - position[other, k])
            before += rotation_before[other, k, i] * (position_before[owner, k] - position_before[other, k])
            v += rotation[other, k, i] * (velocity[owner, k] - velocity[other, k])
            w += rotation[other, k, i] * spin[owner, k]
            u += rotation[other, k, i] * spin[other, k]
        frame[side, 0, i] = now
        frame[side, 3, i] = now - before
        turned[0, i], turned[1, i], turned[2, i] = v, w, u
    # v + w x (q - d) - u x q = (v - w x d) + (w - u) x q
    d0, d1, d2 = frame[side, 0, 0], frame[side, 0, 1], frame[side, 0, 2]
    w0, w1, w2 = turned[1, 0], turned[1, 1], turned[1, 2]
    frame[side, 1, 0] = turned[0, 0] - (w1 * d2 - w2 * d1)
    frame[side, 1, 1] = turned[0, 1] - (w2 * d0 - w0 * d2)
    frame[side, 1, 2] = turned[0, 2] - (w0 * d1 - w1 * d0)
    for i in range(3):
        frame[side, 2, i] = turned[1, i] - turned[2, i]
