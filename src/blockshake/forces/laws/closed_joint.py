"""Rotation of a closed joint against its moment: compliance."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, slopes

_KERN = 1.0 / 3.0  # of the half width: while the resultant is within it the whole face is pressed
_BLOCK = 0.1  # s, over which residuals go together
_FEWEST = 30  # instants


def pressed(forces, place):
    """Instants at which the whole face of a joint is pressed, away from impacts: bool array."""
    face = forces.transmitted.faces[place]
    within = np.abs(forces.transmitted.lever[:, place]) < _KERN * face.half_width
    turn = forces.joints.rotation[:, forces.faces.index(face)]
    return within & forces.joints.steady & np.isfinite(turn)


def closed_joint_law(forces, place):
    """``closed.compliance``: rotation of one joint by its moment while the whole face is pressed [rad/(N m)].

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.
    """
    closed = pressed(forces, place)
    if closed.sum() < _FEWEST:
        return {"closed.compliance": UNTOLD}
    turn = forces.joints.rotation[closed, forces.faces.index(forces.transmitted.faces[place])]
    moment = (forces.transmitted.lever[:, place] * forces.transmitted.normal[:, place])[closed]
    block = (forces.motion.time[closed] / _BLOCK).astype(int)
    return {"closed.compliance": slopes(turn, moment[:, None], block)[0]}
