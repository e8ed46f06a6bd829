"""Rocking of all that a joint carries: how near it came to overturning, and the spin that its impacts keep."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.collapse import COSINE_OF_TILT
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import contact_normals, find_joints, joint_coordinates

# s, from an impact: rates beyond its ringing, and before the swing bends them
_NEAREST, _FARTHEST = 0.005, 0.03
_FEWEST_ROWS = 3  # rows on either side
_SAME_HEIGHT = 1e-3  # m, of joints next to each other
_AS_FAR = 0.8  # of the lever to the other side
_LEAST_SPIN = 0.05  # rad/s: slower closings are elastic


class Carried(NamedTuple):
    """All that stands on a joint, and on what else.

    ``bodies``: indices of all that is held together by joints above it, its upper body among them; ``feet``: rows of
    the joints on which these stand. Empty where the normal of the joint is not up within 45 degrees, or not known.
    """

    bodies: np.ndarray
    feet: np.ndarray


def carried_by(structure):
    """`Carried` of each of `find_joints`, a list."""
    pairs, centres = find_joints(structure)
    up = -np.array(structure.file.gravity)
    up /= max(np.linalg.norm(up), 1e-300)
    bears = contact_normals(structure, pairs) @ up > COSINE_OF_TILT
    height, found = centres @ up, []
    for joint in range(len(pairs)):
        links = pairs[bears & (height > height[joint] + _SAME_HEIGHT)]
        held = coo_array((np.ones(len(links)), links.T), (len(structure.mass),) * 2)
        _, group = connected_components(held, directed=False)
        above = (group == group[pairs[joint, 1]]) & ~structure.driven & bears[joint]
        feet = bears & above[pairs[:, 1]] & ~above[pairs[:, 0]]
        found.append(Carried(np.flatnonzero(above), np.flatnonzero(feet)))
    return found


class StandingColumn(NamedTuple):
    """All that is held together above a driven body, by joints whose normals are up."""

    bodies: np.ndarray  # indices
    centre: np.ndarray  # float64 (3,); common mass centre at the start, world frame [m]
    height: float  # of that centre over the middle of its joints with the driven body [m]
    levers: (
        np.ndarray
    )  # float64 (2,); from that centre to the outermost edges of these joints, to -x and to +x [m]


def columns(structure):
    """Every `StandingColumn` of a structure, a list; none where no body is driven."""
    pairs, centres = find_joints(structure)
    start = rotation_matrices(structure.orientation)
    low, high = (one[0, :, 0] for one in _reach(structure, structure.position[None], start[None]))
    found = {}
    for joint, (bodies, feet) in enumerate(carried_by(structure)):
        if not bodies.size or not structure.driven[pairs[joint, 0]]:
            continue
        mass = structure.mass[bodies]
        centre = mass @ structure.position[bodies] / mass.sum()
        levers = np.array([centre[0] - low[feet].min(), high[feet].max() - centre[0]])
        found[tuple(bodies.tolist())] = StandingColumn(
            bodies, centre, centre[2] - centres[feet, 2].mean(), levers
        )
    return list(found.values())


def overhangs(structure):
    """By index of a free body that stands to one side of its support: the share of the overhang that it may have alone.

    1 where its mass centre is over the edge of what it stands on, along x or along y; 0 where it overhangs nothing. A
    body whose joints are not all up, or that overhangs about as far on the other side, is none of them.
    """
    pairs, _ = find_joints(structure)
    normals = contact_normals(structure, pairs)
    start = rotation_matrices(structure.orientation)
    low, high = (one[0] for one in _reach(structure, structure.position[None], start[None]))
    found = {}
    for body in np.flatnonzero(~structure.driven):
        feet = np.flatnonzero(pairs[:, 1] == body)
        if not len(feet) or (normals[feet, 2] < COSINE_OF_TILT).any():
            continue
        half = 0.5 * np.ptp(structure.solid(body).vertices @ start[body].T, axis=0)[:2]
        centre = structure.position[body, :2]
        levers = np.sort([centre - low[feet].min(axis=0), high[feet].max(axis=0) - centre], axis=0)
        one_sided = levers[0] < _AS_FAR * levers[1]
        share = np.where(one_sided, 1.0 - levers[0] / half, 0.0).max()
        if share > 0.0:
            found[int(body)] = float(share)
    return found


def overturning_margins(structure, position, turns):
    """Least margin against overturning of all that each joint carries, float64 array (n_joints,) [1].

    Parameters
    ----------
    structure : Structure
    position, turns : float64 arrays, shape (n_times, n_bodies, 3) and (n_times, n_bodies, 3, 3)
        Mass centres [m], and body to world.

    Returns
    -------
    float64 array, shape (n_joints,)
        Joints as of `find_joints`. 1 as at the start; 0 where the mass centre of all above is over the edge of what it
        stands on, from which it does not come back at rest; below 0 beyond it. NaN where a joint carries nothing, or
        where the mass centre lies outside at the start.

    Notes
    -----
    The distance of the mass centre from the nearest edge, along x or along y, over that at the start. A block that
    leans by ``t`` and is slender by ``a`` has ``sin(a - t) / sin(a)`` (Housner 1963). The edges are those of what both
    faces of each joint have in common, around all joints that carry the same bodies, by bounding boxes at the start.
    """
    margins = np.full(len(find_joints(structure)[0]), np.nan)
    reach = _reach(structure, position, turns)
    for joint, (bodies, feet) in enumerate(carried_by(structure)):
        if not bodies.size:
            continue
        mass = structure.mass[bodies] / structure.mass[bodies].sum()
        centre = np.einsum("b,tbi->ti", mass, position[:, bodies, :2])
        low, high = reach[0][:, feet].min(axis=1), reach[1][:, feet].max(axis=1)
        nearest = np.minimum(centre - low, high - centre)
        if (nearest[0] > 0.0).all():
            margins[joint] = np.nanmin(nearest / nearest[0])
    return margins


def _reach(structure, position, turns):
    """Lowest and highest x and y of the area that both bodies of every joint have, (2, n_times, n_joints, 2) [m]."""
    pairs, centres = find_joints(structure)
    start = rotation_matrices(structure.orientation)
    reach = []
    for side in (0, 1):
        low, high = np.empty((2, len(position), len(pairs), 2))
        for joint, body in enumerate(pairs[:, side]):
            corners = structure.position[body] + structure.solid(body).vertices @ start[body].T
            ends = [corners.min(axis=0), corners.max(axis=0)]
            face = [[ends[i][0], ends[j][1], centres[joint, 2]] for i in (0, 1) for j in (0, 1)]
            arms = (np.array(face) - structure.position[body]) @ start[body]
            seen = position[:, body, None, :2] + np.einsum("tik,ck->tci", turns[:, body, :2], arms)
            low[:, joint], high[:, joint] = seen.min(axis=1), seen.max(axis=1)
        reach.append((low, high))
    (lower_low, lower_high), (upper_low, upper_high) = reach
    return np.maximum(lower_low, upper_low), np.minimum(lower_high, upper_high)


def angular_momentum_ratio(structure, time, position, turns, angular_velocity):
    """Share of the spin across each joint that its impacts keep, median over them, float64 array (n_joints,) [1].

    ``time`` (n_times,) [s]; ``angular_velocity`` (n_times, n_bodies, 3), world frame [rad/s]; others as of
    `overturning_margins`. NaN without impacts.

    Notes
    -----
    An impact is where a joint that turns about its axis along x or y, whichever turns more, passes through closed to
    its other edge. The spin is that of the upper body against the lower one; lines through it, over 25 ms on either
    side, are carried to the instant of the impact. Where the lower body stands still, and all above turns as one, a
    share compares with `plastic_shares`.
    """
    kept = np.full(len(find_joints(structure)[0]), np.nan)
    if not len(kept) or len(time) < 2:
        return kept
    pairs, _ = find_joints(structure)
    turned = joint_coordinates(structure, position, turns)["rotation"].to_numpy()
    lower, upper = pairs.T
    rates = np.einsum(
        "tjki,tjk->tji", turns[:, lower], angular_velocity[:, upper] - angular_velocity[:, lower]
    )
    for joint in range(len(pairs)):
        axis = int(np.nanargmax(np.abs(turned[:, joint, :2]).max(axis=0)))
        shares = list(_shares(time, turned[:, joint, axis], rates[:, joint, axis]))
        kept[joint] = np.median(shares) if shares else np.nan
    return kept


def _shares(time, angle, rate):
    """Share of the spin kept at each passage of an angle [rad] through zero."""
    for row in np.flatnonzero(angle[:-1] * angle[1:] < 0.0):
        at = time[row] + (time[row + 1] - time[row]) * angle[row] / (angle[row] - angle[row + 1])
        since = time - at
        before = np.flatnonzero((since > -_FARTHEST) & (since < -_NEAREST))
        after = np.flatnonzero((since < _FARTHEST) & (since > _NEAREST))
        if min(len(before), len(after)) < _FEWEST_ROWS:
            continue
        sides = np.sign(angle[before]), np.sign(angle[after])
        if (sides[0] != sides[0][0]).any() or (sides[1] != -sides[0][0]).any():
            continue
        spins = [np.polyfit(since[rows], rate[rows], 1)[1] for rows in (before, after)]
        if abs(spins[0]) > _LEAST_SPIN:
            yield spins[1] / spins[0]


def plastic_shares(structure):
    """Share of the spin about y that an impact keeps if all above a joint turns as one and is struck at the other edge
    alone (Housner 1963), float64 array (n_joints,) [1]; NaN where a joint carries nothing."""
    _, centres = find_joints(structure)
    start = rotation_matrices(structure.orientation)
    low, high = (one[0, :, 0] for one in _reach(structure, structure.position[None], start[None]))
    shares = np.full(len(centres), np.nan)
    for joint, (bodies, feet) in enumerate(carried_by(structure)):
        if not bodies.size:
            continue
        mass, place = structure.mass[bodies], structure.position[bodies]
        centre = mass @ place / mass.sum()
        arms = (place - centre)[:, [0, 2]]
        own = np.einsum("bi,bij,bj->", start[bodies, 1], structure.inertia[bodies], start[bodies, 1])
        spin = own + mass @ (arms**2).sum(axis=1) + mass.sum() * (centre[2] - centres[joint, 2]) ** 2
        left, right = centre[0] - low[feet].min(), high[feet].max() - centre[0]
        shares[joint] = (spin - mass.sum() * left * right) / (spin + mass.sum() * left**2)
    return shares
