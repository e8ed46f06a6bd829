"""Pairs of bodies whose boxes are near, and the depth by which two convex solids overlap (separating-axis theorem)."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.jit import inner_kernel

_MOST_AT_ONCE = 2**19  # pairs of edges, or of faces and corners, held at a time: some tens of megabytes


def near_pairs(solids, position, orientation, clearance):
    """Pairs of bodies whose boxes along the world's axes come within ``clearance`` [m], as `find_pairs` gives them.

    ``solids``: `Solid` of each body; ``position`` (n_bodies, 3): mass centres [m]; ``orientation`` (n_bodies, 4): unit
    quaternions (w, x, y, z), body to world.
    """
    turned = rotation_matrices(orientation)
    corners = [solid.vertices @ rotation.T for solid, rotation in zip(solids, turned, strict=True)]
    low = position + [points.min(axis=0) for points in corners]
    high = position + [points.max(axis=0) for points in corners]
    # plain Python: to load a structure compiles nothing
    return find_pairs(low, high, np.zeros(len(low), dtype=bool), clearance)


@inner_kernel
def find_pairs(low, high, driven, margin):
    """Pairs whose bounding boxes come within ``margin`` [m]: int64 (n_pairs, 2), sorted; not of two driven bodies.

    ``low``, ``high`` (n_bodies, 3): corners of the boxes, world frame [m]; ``driven`` bool (n_bodies,). A sweep over
    the sorted lower ends along the axis on which the bodies are spread most, so that the cost grows with the bodies and
    the neighbours of each.
    """
    n_bodies = driven.size
    widest, most = 0, -1.0
    for axis in range(3):
        least, greatest = np.inf, -np.inf
        for body in range(n_bodies):
            least, greatest = min(least, low[body, axis]), max(greatest, low[body, axis])
        if greatest - least > most:
            widest, most = axis, greatest - least
    order = np.argsort(low[:, widest].copy(), kind="mergesort")
    # a pair as one number, and that not an integer, whose order would be sought by code of its own
    codes = []
    for rank in range(n_bodies):
        a = order[rank]
        for later in range(rank + 1, n_bodies):
            b = order[later]
            if low[b, widest] > high[a, widest] + margin:
                break
            near = not (driven[a] and driven[b])
            for axis in range(3):
                near &= low[a, axis] <= high[b, axis] + margin and low[b, axis] <= high[a, axis] + margin
            if near:
                codes.append(1.0 * (min(a, b) * n_bodies + max(a, b)))
    order = np.argsort(np.array(codes), kind="mergesort") if codes else np.empty(0, np.int64)
    pairs = np.empty((len(codes), 2), np.int64)
    for pair in range(len(codes)):
        code = np.int64(codes[order[pair]])
        pairs[pair, 0], pairs[pair, 1] = code // n_bodies, code % n_bodies
    return pairs


def penetration_depths(solid_a, positions_a, orientations_a, solid_b, positions_b, orientations_b):
    """Depths of overlap of pairs of the same two convex solids, each along the pair's axis of least overlap.

    Parameters
    ----------
    solid_a, solid_b : Solid
        Shapes about their mass centres.
    positions_a, positions_b : float64 arrays, shape (n_pairs, 3)
        Mass centres, world frame [m].
    orientations_a, orientations_b : float64 arrays, shape (n_pairs, 4)
        Unit quaternions (w, x, y, z), body to world.

    Returns
    -------
    float64 array, shape (n_pairs,)
        [m]; negative is a lower bound of the clearance. Zero for a pair with a shape that is not convex, whose overlap
        this test cannot tell.
    """
    depths = np.zeros(len(positions_a))
    if solid_a.polyhedron is None or solid_b.polyhedron is None:
        return depths
    # everything in the frame of a, where its own normals and edges are the same for all pairs
    world_a, world_b = rotation_matrices(orientations_a), rotation_matrices(orientations_b)
    rotation = world_a.transpose(0, 2, 1) @ world_b
    offset = np.einsum("pji,pj->pi", world_a, positions_b - positions_a)
    edges_a, edges_b = _edges(solid_a.polyhedron), _edges(solid_b.polyhedron)
    at_once = max(1, _MOST_AT_ONCE // (len(edges_a[0]) * len(edges_b[0])))
    for first in range(0, len(depths), at_once):
        pairs = slice(first, first + at_once)
        turn, shift = rotation[pairs], offset[pairs]
        back = -np.einsum("pji,pj->pi", turn, shift)
        depth = np.minimum(
            _face_overlap(solid_a, solid_b, turn, shift),
            _face_overlap(solid_b, solid_a, turn.transpose(0, 2, 1), back),
        )
        rows = max(1, _MOST_AT_ONCE // len(edges_b[0]))
        for start in range(0, len(edges_a[0]), rows):
            part = [values[start : start + rows] for values in edges_a]
            depth = np.minimum(depth, _edge_overlap(part, edges_b, turn, shift, solid_a, solid_b))
        depths[pairs] = depth
    return depths


def depths_of_pairs(pairs, shapes, solids, position, orientation):
    """`penetration_depths` of pairs of bodies, those of the same two shapes at once: float64 array (n_pairs,) [m].

    ``pairs`` int64 (n_pairs, 2); ``shapes``: shape of each body; ``solids``: `Solid` by shape. ``position`` (n_bodies,
    3) and ``orientation`` (n_bodies, 4) are those of the solids' origins [m].
    """
    depth, by_shapes = np.empty(len(pairs)), {}
    for index, (a, b) in enumerate(pairs):
        by_shapes.setdefault((shapes[a], shapes[b]), []).append(index)
    for (first, second), indices in by_shapes.items():
        a, b = pairs[indices].T
        depth[indices] = penetration_depths(
            solids[first], position[a], orientation[a], solids[second], position[b], orientation[b]
        )
    return depth


def _face_overlap(solid, other, rotation, offset):
    """Least overlap along the normals of one solid's faces, in its frame, for every pose of the other [m]."""
    normals, reach = solid.polyhedron.normals, solid.polyhedron.offsets
    least = np.full(len(rotation), np.inf)
    rows = max(1, _MOST_AT_ONCE // (len(rotation) * len(other.vertices)))
    for start in range(0, len(normals), rows):
        part = normals[start : start + rows]
        nearest = ((part @ rotation) @ other.vertices.T).min(axis=2) + offset @ part.T
        least = np.minimum(least, (reach[start : start + rows] - nearest).min(axis=1))
    return least


def _edge_overlap(edges_a, edges_b, rotation, offset, solid_a, solid_b):
    """Least overlap along the normals to an edge of each, for every pose of the second [m].

    Only two edges that form a face of the Minkowski difference can have the least: those whose
    arcs between their faces' normals cross on the unit sphere, the second's turned around
    (Gregorius 2013, The separating axis test between convex polyhedra, Game Developers Conference).
    The overlap along a normal is that of all corners: the thin faces of a scanned surface have normals of rounding,
    whose arcs can cross where the edges form no face.
    """
    along_a, left_a, right_a = edges_a
    along_b, left_b, right_b = (values @ rotation.transpose(0, 2, 1) for values in edges_b)
    # sides of the plane of one arc on which the ends of the other lie
    b_left, b_right = -along_a @ left_b.transpose(0, 2, 1), -along_a @ right_b.transpose(0, 2, 1)
    a_left = left_a @ along_b.transpose(0, 2, 1)
    a_right = right_a @ along_b.transpose(0, 2, 1)
    crossing = (b_left * b_right < 0.0) & (a_left * a_right < 0.0) & (b_left * a_right > 0.0)
    pair, a, b = np.nonzero(crossing)
    axes = np.cross(along_a[a], along_b[pair, b])
    lengths = np.linalg.norm(axes, axis=1)
    kept = lengths > 1e-9
    pair, a, b, axes = pair[kept], a[kept], b[kept], axes[kept] / lengths[kept, None]
    axes *= np.sign((axes * (left_a[a] + right_a[a])).sum(axis=1))[:, None]
    least = np.full(len(rotation), np.inf)
    rows = max(1, _MOST_AT_ONCE // (len(solid_a.vertices) + len(solid_b.vertices)))
    for start in range(0, len(pair), rows):
        of, axis = pair[start : start + rows], axes[start : start + rows]
        ends = (axis @ solid_a.vertices.T).max(axis=1)
        turned = (axis[:, None] @ rotation[of])[:, 0]  # in the second's frame
        begins = (turned @ solid_b.vertices.T).min(axis=1) + (axis * offset[of]).sum(axis=1)
        np.minimum.at(least, of, ends - begins)
    return least


def _edges(polyhedron):
    """Unit direction and the unit normals of the faces to the left and right of every edge, (n_edges, 3) each."""
    starts = np.concatenate(polyhedron.faces)
    ends = np.concatenate([np.roll(face, -1) for face in polyhedron.faces])
    face = np.repeat(np.arange(len(polyhedron.faces)), [len(face) for face in polyhedron.faces])
    n_vertices = len(polyhedron.vertices)
    there, back = np.argsort(starts * n_vertices + ends), np.argsort(ends * n_vertices + starts)
    once = starts[there] < ends[there]
    there, back = there[once], back[once]
    along = polyhedron.vertices[ends[there]] - polyhedron.vertices[starts[there]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    return [
        along,
        polyhedron.normals[face[there]],
        polyhedron.normals[face[back]],
    ]
