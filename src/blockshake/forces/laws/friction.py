"""Friction while a joint slips, and how it goes with the slip rate."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, of_blocks, runs_of, slopes

SLIPS = 0.01  # m/s, and five standard deviations: less is no slip
_SURE = 5.0
_FEWEST = 20  # instants
_LEAST_DECADES = 0.3  # of slip rates, that a slope is told from


def slipping(forces, place):
    """Instants at which a joint slips, away from impacts, which move the bearing edge and are no slip: bool array."""
    joint = forces.faces.index(forces.transmitted.faces[place])
    least = max(SLIPS, _SURE * forces.joints.slip_rate_error[joint])
    fast = np.abs(forces.joints.slip_rate[:, joint]) > least
    return forces.joints.steady & fast & (forces.transmitted.normal[:, place] > 0.0)


def friction_law(forces, place):
    """Statistics of one joint's friction, by name.

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.

    Returns
    -------
    dict of str to Statistic
        ``friction.loss``: share of the structure's coefficient that the ratio of shear to normal force against the
        slip lacks [1]; ``friction.rate``: change of that ratio by decade of the slip rate, over the coefficient [1].

    Notes
    -----
    Coulomb: the shear of a slipping joint is mu N against the slip rate.
    """
    face = forces.transmitted.faces[place]
    rate = forces.joints.slip_rate[:, forces.faces.index(face)]
    slips = slipping(forces, place)
    names = ("friction.loss", "friction.rate")
    if slips.sum() < _FEWEST:
        return dict.fromkeys(names, UNTOLD)
    run = runs_of(slips)[slips]
    ratio = -np.sign(rate[slips]) * forces.transmitted.friction[slips, place] / face.friction
    decades = np.log10(np.abs(rate[slips]))
    mean = of_blocks(ratio, run)
    loss = mean._replace(value=1.0 - mean.value)
    change = slopes(ratio, decades[:, None], run)[0] if np.ptp(decades) > _LEAST_DECADES else UNTOLD
    return dict(zip(names, (loss, change), strict=True))
