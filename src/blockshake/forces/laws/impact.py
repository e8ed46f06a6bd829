"""Impacts: the angular velocity that is kept, and the ringing of the joints above."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, Statistic, of_blocks

_AROUND = 0.06  # s, from the impact to where the angular velocity is read: beyond the kernel's reach
_RINGS = (0.06, 0.25)  # s, after it
_FEWEST = 2  # impacts
_LEAST_SPIN = 0.01  # rad/s before it
_LEAST_TO_RING = 0.06  # rad/s before it: slower impacts ring no louder than the noise of levers


def impact_law(forces, place):
    """Statistics of a rocking joint's impacts, by name.

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.

    Returns
    -------
    dict of str to Statistic
        ``impact.kept``: angular velocity after over before, of the upper body (Housner 1963) [1]; ``impact.ringing``:
        root mean square of the lever of the joint above about its course, while it rings, over the size of the
        angular velocity before [m s/rad].
    """
    joint = forces.faces.index(forces.transmitted.faces[place])
    upper = forces.faces[joint].upper
    time, side = forces.motion.time, forces.joints.side[:, joint]
    spin = forces.motion.angular_velocity[:, upper, 1]
    step = float(np.median(np.diff(time)))
    away = round(_AROUND / step)
    above = [
        number
        for number, face in enumerate(forces.transmitted.faces)
        if face.lower == forces.faces[joint].upper
    ]
    kept, rings = [], []
    for before, after in _crossings(side):
        first, last = before - away, after + away
        if first < 0 or last >= len(time) or after - before > away:
            continue
        if side[first] != side[before] or side[last] != side[after] or abs(spin[first]) < _LEAST_SPIN:
            continue
        kept.append(spin[last] / spin[first])
        if above and abs(spin[first]) > _LEAST_TO_RING:
            rings.append(
                _ringing(forces.transmitted.lever[:, above[0]], after, step, side) / abs(spin[first])
            )
    rings = [one for one in rings if np.isfinite(one)]
    return {
        "impact.kept": _median(kept),
        "impact.ringing": _median(rings),
    }


def _crossings(side):
    """Last instant on one edge and first one on the other, of every change from edge to edge."""
    turned = np.flatnonzero(side != 0)
    changes = np.flatnonzero(side[turned[1:]] != side[turned[:-1]])
    return [(turned[one], turned[one + 1]) for one in changes]


def _ringing(lever, after, step, side):
    """Root mean square of a lever about a straight line, from soon after an impact on, while the joint stays turned."""
    first, last = after + round(_RINGS[0] / step), after + round(_RINGS[1] / step)
    own = lever[first:last]
    if len(own) < round((_RINGS[1] - _RINGS[0]) / step) or (side[first:last] != side[after]).any():
        return np.nan
    if not np.isfinite(own).all():
        return np.nan
    line = np.polynomial.Polynomial.fit(np.arange(len(own)), own, 1)
    return float(np.sqrt(np.mean((own - line(np.arange(len(own)))) ** 2)))


def _median(values):
    if len(values) < _FEWEST:
        return UNTOLD
    found = of_blocks(np.array(values), np.arange(len(values)))
    return Statistic(float(np.median(values)), found.error)
