"""Rotation of a closed joint against its moment: compliance."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, slopes

_KERN = 1.0 / 3.0  # of the half width: while the resultant is within it the whole face is pressed
_BLOCK = 0.1  # s, over which residuals go together
_FEWEST = 30  # instants


def closed_joint_law(forces, place):
    """``closed.compliance``: rotation of one joint by its moment while the whole face is pressed [rad/(N m)].

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.
    """
    face = forces.transmitted.faces[place]
    joint = forces.faces.index(face)
    lever = forces.transmitted.lever[:, place]
    turn = forces.joints.rotation[:, joint]
    pressed = (np.abs(lever) < _KERN * face.half_width) & forces.joints.steady & np.isfinite(turn)
    if pressed.sum() < _FEWEST:
        return {"closed.compliance": UNTOLD}
    moment = (lever * forces.transmitted.normal[:, place])[pressed]
    block = (forces.motion.time[pressed] / _BLOCK).astype(int)
    return {"closed.compliance": slopes(turn[pressed], moment[:, None], block)[0]}
