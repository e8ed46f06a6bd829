"""Blocks that still fall when a run ends: no forces on their faces can carry them where they are bound to."""

import dataclasses
from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import csc_array, eye_array, hstack, vstack

from blockshake.dynamics.collapse import COSINE_OF_TILT, collapse_limits
from blockshake.dynamics.system import State, assemble_bodies
from blockshake.geometry.overlap import near_pairs
from blockshake.geometry.polyhedron import convex_polyhedron
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import parting_normal
from blockshake.solvers.external_forces import closure_into

_TOUCH = 1e-3  # m, below which two surfaces touch: rattling blocks hop by less
_EDGES = 16  # of the pyramid of friction: within 2 % of the cone, whichever way an arch spans
_UNCARRIED = 1e-4  # of the weight of a block, or of it at a lever of the block's size, that counts as carried


class _Support(NamedTuple):
    """Where a body may press another one.

    ``lower`` and ``upper``: bodies, both the same for a stopper; ``normal`` from the lower to the upper, unit vector;
    ``corners``, ``limits``: of the areas of the upper and of the lower body on which the force acts, (n, 3) [m];
    ``friction`` [1]; ``pivot``: where the upper body is nearest [m]; ``carries``: its normal is up, within 45 degrees.
    """

    lower: int
    upper: int
    normal: np.ndarray
    corners: np.ndarray
    limits: np.ndarray
    friction: float
    pivot: np.ndarray
    carries: bool


def still_falling(structure, position, orientation, angular_velocity):
    """Name of a body that still falls, or None where none does.

    Parameters
    ----------
    structure : Structure
    position, angular_velocity : float64 arrays, shape (n_bodies, 3)
        Mass centres and rates at one instant, world frame [m, rad/s].
    orientation : float64 array, shape (n_bodies, 4)
        Unit quaternions (w, x, y, z), body to world.

    Returns
    -------
    str or None
        Body, of those that `collapse_limits` watches, whose weight drives the fall most.

    Notes
    -----
    By the static theorem of limit analysis nothing falls where some compressive forces within friction carry all
    weights (Heyman 1966, The stone skeleton; Livesey 1978, Limit analysis of structures formed from rigid blocks).
    Forces act anywhere on two faces that lie over each other. An open joint counts as closed, as it does when a block
    comes back, unless the block then lies lower than a collapse allows; bodies that did not touch at the start carry
    each other only where they touch.

    The blocks are taken to be where they are bound to (the extrapolated mass centre of Hof, Gazendam and Sinke 2005,
    The condition for dynamic stability): ``u / p`` on, where ``u`` is the velocity by their turning alone and ``p`` the
    rate of the inverted pendulum that turns so. For blocks that turn as one about an edge that asks whether their
    energy takes them over the point of balance; the rate at which it does is right within 1 % where the height is four
    times the width, within 3 % where it is twice.

    The ground moves on evenly. Slip and flight change nothing: friction and weight end them. A structure with a free
    body that is not convex is not judged.
    """
    watched, drop_limit = collapse_limits(structure)
    gravity = np.array(structure.file.gravity)
    strength = np.linalg.norm(gravity)
    if not watched.any() or strength == 0.0:
        return None
    if any(structure.solid(body).polyhedron is None for body in np.flatnonzero(watched)):
        return None
    up, base = -gravity / strength, int(np.argmax(structure.driven))
    # in the frame of the base, which may have tilted
    from_base = (position - position[base]) @ _turn_since_start(structure, orientation, base)
    fallen = (structure.position - structure.position[base] - from_base) @ up
    supports = [
        *_supports(structure, position, orientation, up, watched, drop_limit - fallen),
        *_stops(structure, position, orientation, watched, base),
    ]
    turning = np.where(watched[:, None], angular_velocity - angular_velocity[base], 0.0)
    turning -= np.outer(turning @ up, up)
    speed, bend = _carried_along(supports, position, turning, up)
    spin = np.einsum("bji,bj->bi", rotation_matrices(orientation), turning)
    moving = structure.mass @ (speed**2).sum(axis=1) + np.einsum("bi,bij,bj->", spin, structure.inertia, spin)
    driving = -strength * structure.mass @ (bend @ up)
    period = np.sqrt(moving / driving) if driving > 0.0 else 0.0

    def moved(points, body):
        return points + period * (speed[body] + np.cross(turning[body], points - position[body]))

    ahead = [
        support._replace(
            corners=moved(support.corners, support.upper), limits=moved(support.limits, support.lower)
        )
        for support in supports
    ]
    body = _uncarried(structure, ahead, position + period * speed, up, watched)
    return None if body is None else structure.body_names[body]


def _turn_since_start(structure, orientation, body):
    """Rotation matrix of a body from its orientation at the start, (3, 3)."""
    now, start = (
        rotation_matrices(orientation[[body]])[0],
        rotation_matrices(structure.orientation[[body]])[0],
    )
    return now @ start.T


def _supports(structure, position, orientation, up, watched, most_gap):
    """`_Support` of each pair that touches, or that touched and has at most a gap [m] to come down by."""
    taken = np.flatnonzero(watched | structure.driven)
    hulls, turns = [_hull(structure.solid(body)) for body in taken], rotation_matrices(orientation)[taken]
    corners = [
        centre + hull.vertices @ turn.T
        for centre, hull, turn in zip(position[taken], hulls, turns, strict=True)
    ]
    supports = []
    reach = max(_TOUCH, most_gap[watched].max())
    for pair in near_pairs(hulls, position[taken], orientation[taken], reach):
        normal = parting_normal(*(part[body] for body in pair for part in (hulls, corners, turns)))
        if normal @ up < 0.0:
            pair, normal = pair[::-1], -normal
        below, above = pair
        depth, height = corners[below] @ normal, corners[above] @ normal
        carries = normal @ up > COSINE_OF_TILT
        joined = structure.touching[taken[below], taken[above]]
        if height.min() - depth.max() > (most_gap[taken[above]] if joined and carries else _TOUCH):
            continue
        near = height < height.min() + _TOUCH
        supports.append(
            _Support(
                lower=taken[below],
                upper=taken[above],
                normal=normal,
                corners=corners[above][near | _facing(hulls[above], -normal @ turns[above])],
                limits=corners[below][
                    (depth > depth.max() - _TOUCH) | _facing(hulls[below], normal @ turns[below])
                ],
                # arches and keystones hang on steep joints; blocks that came side by side lean on each other alone
                friction=np.nan_to_num(structure.friction[taken[below], taken[above]])
                if carries or joined
                else 0.0,
                pivot=corners[above][near].mean(axis=0),
                carries=carries,
            )
        )
    return supports


def _hull(solid):
    """A solid as a convex one."""
    hull = solid.polyhedron or convex_polyhedron(solid.vertices)
    return dataclasses.replace(solid, vertices=hull.vertices, polyhedron=hull)


def _facing(hull, direction):
    """Corners, a mask, of the largest face that looks within 45 degrees of a direction in the body's frame."""
    facing = np.zeros(len(hull.vertices), dtype=bool)
    largest = 0.0
    for face in np.flatnonzero(hull.polyhedron.normals @ direction > COSINE_OF_TILT):
        corners = hull.polyhedron.faces[face]
        sides = hull.vertices[corners[1:]] - hull.vertices[corners[0]]
        area = np.linalg.norm(np.cross(sides[:-1], sides[1:]).sum(axis=0))
        if area > largest:
            largest, facing = area, np.isin(np.arange(len(facing)), corners)
    return facing


def _stops(structure, position, orientation, watched, base):
    """`_Support` of each body that leans on a stopper."""
    bodies, _, stoppers = assemble_bodies(structure)
    state = State(position, orientation, np.zeros_like(position), np.zeros_like(position))
    for stop, body in enumerate(() if stoppers is None else stoppers.body):
        reach, arm, toward = np.empty((3, 3))
        if watched[body] and closure_into(bodies, stoppers, stop, base, state, reach, arm, toward) > -_TOUCH:
            point = (position[body] + arm)[None]
            yield _Support(body, body, -toward, point, point, 0.0, point[0], carries=False)


def _carried_along(supports, position, turning, up):
    """Velocity and centripetal acceleration of the mass centres, were all blocks pinned where they stand, (n, 3)."""
    speed, bend = np.zeros((2, *position.shape))
    for body in np.argsort(position @ up, kind="stable"):
        below = [support for support in supports if support.upper == body and support.carries]
        for support in below:
            speed[body] += speed[support.lower] / len(below)
            bend[body] += bend[support.lower] / len(below)
            for carrier, arm in (
                (support.lower, support.pivot - position[support.lower]),
                (body, position[body] - support.pivot),
            ):
                around = np.cross(turning[carrier], arm)
                speed[body] += around / len(below)
                bend[body] += np.cross(turning[carrier], around) / len(below)
    return speed, bend


def _uncarried(structure, supports, ahead, up, watched):
    """Body whose weight drives the motion that no forces on the supports can stop; None where some forces do.

    A linear program: the least sum of forces and moments, with those on the supports, with which all weights at
    their places ``ahead`` [m] are carried. Its multipliers are the motion.
    """
    bodies = np.flatnonzero(watched)
    size = [np.ptp(structure.solid(body).vertices, axis=0).max() for body in bodies]
    unit = structure.mass[bodies].min()  # of forces; the rows of a body are over its weight and its size
    columns = []
    for index, support in enumerate(supports):
        tangents = np.linalg.svd(support.normal[None])[2][1:]
        # a force within friction is a sum of forces along the edges of a pyramid
        edges = [
            support.normal + support.friction * (np.cos(turn) * tangents[0] + np.sin(turn) * tangents[1])
            for turn in np.arange(_EDGES) * 2.0 * np.pi / _EDGES
        ]
        force = np.repeat(edges, len(support.corners), axis=0)
        corners = np.tile(support.corners, (len(edges), 1))
        column = np.zeros((6 * len(bodies) + 3 * len(supports), len(corners) + len(support.limits)))
        for row, body in enumerate(bodies):
            if body in (support.lower, support.upper):
                wrench = np.hstack([force, np.cross(corners - ahead[body], force) / size[row]])
                sign = 1.0 if body == support.upper else -1.0
                column[6 * row : 6 * row + 6, : len(corners)] = sign * unit / structure.mass[body] * wrench.T
        # the resultant acts on both areas
        rows = slice(6 * len(bodies) + 3 * index, 6 * len(bodies) + 3 * index + 3)
        for points, sign, within in (
            (corners, 1.0, slice(0, len(corners))),
            (support.limits, -1.0, slice(len(corners), None)),
        ):
            column[rows, within] = sign * np.vstack(
                [tangents @ (points - support.pivot).T, np.ones(len(points))]
            )
        columns.append(csc_array(column))
    slack = eye_array(6 * len(bodies))
    slack = vstack([slack, csc_array((3 * len(supports), 6 * len(bodies)))])
    matrix = hstack([slack, -slack, *columns], format="csc")
    weights = np.zeros((len(bodies), 6))
    weights[:, :3] = up
    wanted = np.concatenate([weights.ravel(), np.zeros(3 * len(supports))])
    cost = np.zeros(matrix.shape[1])
    cost[: 2 * slack.shape[1]] = 1.0
    program = scipy.optimize.linprog(cost, A_eq=matrix, b_eq=wanted, method="highs")
    if program.fun < _UNCARRIED:
        return None
    motion = program.eqlin.marginals[: weights.size].reshape(weights.shape)
    return int(bodies[(motion * weights).sum(axis=1).argmax()])
