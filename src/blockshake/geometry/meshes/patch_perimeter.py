"""Points just inside the sharp convex edges of a face of a mesh: where a body stands when it rocks."""

from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

SHARP = np.radians(30.0)  # angle between the normals of two triangles that meet at an edge of the body


def edge_pairs(faces, n_vertices):
    """The two triangles that share each edge of a closed surface: int64 array, shape (n_edges, 2)."""
    start, end = faces, np.roll(faces, -1, axis=1)
    code = (np.minimum(start, end) * n_vertices + np.maximum(start, end)).ravel()
    order = np.argsort(code, kind="stable")
    return (order // 3).reshape(-1, 2)


def boundaries(vertices, faces, normals, patch):
    """Edges around each smooth part of a closed surface.

    Parameters
    ----------
    vertices, faces, normals : float64 (n_vertices, 3), int64 (n_triangles, 3), float64 (n_triangles, 3)
        Outward triangles and their unit normals, zero for a triangle without area.
    patch : int array, shape (n_triangles,)
        Part of each triangle.

    Returns
    -------
    dict of int to list of (start, end, triangle, convex)
        By part: vertices of each edge, the part on its left seen from outside; its triangle in
        the part; whether the body is convex there.
    """
    owner = {}
    for triangle, (a, b, c) in enumerate(faces.tolist()):
        owner[a, b], owner[b, c], owner[c, a] = (triangle, c), (triangle, a), (triangle, b)
    sides = {}
    for (start, end), (triangle, _) in owner.items():
        other, opposite = owner[end, start]
        if patch[other] != patch[triangle]:
            convex = bool(normals[triangle] @ (vertices[opposite] - vertices[start]) < 0.0)
            sides.setdefault(int(patch[triangle]), []).append((start, end, triangle, convex))
    return sides


def perimeter_points(vertices, normals, sides, area, spacing, inset):
    """Evenly spaced points along the convex edges of one smooth part of a surface.

    Parameters
    ----------
    vertices, normals : as in `boundaries`
    sides : list
        The part's edges, from `boundaries`.
    area : float
        The part [m2].
    spacing, inset : float
        As in `mesh_nodes`.

    Returns
    -------
    float64 array, shape (n_points, 3)
        In the planes of the triangles along the edge [m]; each straight piece begins and ends where it is ``inset``
        away from the next piece too, and has at least two intervals if it is as long as the spacing.
    """
    points = [np.empty((0, 3))]
    if sides:
        inset *= 2.0 * area / _length(vertices, sides)
    for loop in _loops(sides):
        for chain in _chains(loop, vertices, normals):
            if chain[1][0][3]:
                points.append(_along(chain, vertices, normals, spacing, inset))
    points = np.vstack(points)
    if len(points) == 0:
        return points
    doubles = cKDTree(points).query_pairs(0.5 * inset, output_type="ndarray")
    return np.delete(points, np.unique(doubles[:, 1]), axis=0)


def _length(vertices, sides):
    return sum(np.linalg.norm(vertices[end] - vertices[start]) for start, end, _, _ in sides)


def _loops(sides):
    """Edges put end to end into closed loops."""
    leaving = {}
    for side in sides:
        leaving.setdefault(side[0], []).append(side)
    loops = []
    while leaving:
        first = next(iter(leaving))
        loop, at = [], first
        while at in leaving:
            side = leaving[at].pop(0)
            if not leaving[at]:
                del leaving[at]
            loop.append(side)
            at = side[1]
        loops.append(loop)
    return loops


def _turn(before, after, vertices, normals):
    """Angle by which the perimeter turns to the left between two edges [rad]."""
    d, e = vertices[before[1]] - vertices[before[0]], vertices[after[1]] - vertices[after[0]]
    normal = normals[before[2]] + normals[after[2]]
    across = np.cross(d, e) @ normal / np.linalg.norm(normal)
    return np.arctan2(across, d @ e)


def _chains(loop, vertices, normals):
    """Pieces of a loop between corners as (edge before, edges, edge after); None twice for one without corners."""
    breaks = [
        index
        for index, side in enumerate(loop)
        if abs(_turn(loop[index - 1], side, vertices, normals)) > SHARP or loop[index - 1][3] != side[3]
    ]
    if not breaks:
        return [(None, loop, None)]
    turned = loop[breaks[0] :] + loop[: breaks[0]]
    bounds = [index - breaks[0] for index in breaks] + [len(loop)]
    return [
        (turned[start - 1], turned[start:end], turned[end % len(loop)]) for start, end in pairwise(bounds)
    ]


def _along(chain, vertices, normals, spacing, inset):
    """Points ``inset`` to the left of a chain, evenly spaced."""
    before, sides, after = chain
    starts = np.array([vertices[side[0]] for side in sides])
    steps = np.array([vertices[side[1]] for side in sides]) - starts
    lengths = np.linalg.norm(steps, axis=1)
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    n_intervals = max(1 if reached[-1] < spacing else 2, round(reached[-1] / spacing))
    if before is None:
        positions = (np.arange(n_intervals) + 0.5) * reached[-1] / n_intervals
    else:
        # where the perimeter turns by an angle t, a point at the inset from both edges is inset tan(t / 2) along
        skipped = [
            np.clip(inset * np.tan(0.5 * _turn(*edges, vertices, normals)), 0.0, 0.45 * reached[-1])
            for edges in ((before, sides[0]), (sides[-1], after))
        ]
        positions = np.linspace(skipped[0], reached[-1] - skipped[1], n_intervals + 1)
    piece = np.clip(np.searchsorted(reached, positions, side="right") - 1, 0, len(sides) - 1)
    direction = steps[piece] / lengths[piece, None]
    inward = np.cross(normals[[sides[k][2] for k in piece]], direction)
    return starts[piece] + (positions - reached[piece])[:, None] * direction + inset * inward
