"""Normals of the contacts of touching bodies: the way along which either of the two can be lifted off the other."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices


def contact_normals(structure, pairs):
    """Unit normals of the contacts of pairs of bodies at the start.

    Parameters
    ----------
    structure : Structure
    pairs : int array, shape (n_pairs, 2)
        Bodies that touch.

    Returns
    -------
    float64 array, shape (n_pairs, 3)
        From the first body to the second, world frame [1]; NaN where a shape is not convex.
    """
    turns = rotation_matrices(structure.orientation)
    solids = [structure.solid(body) for body in range(len(structure.mass))]
    corners = [
        place + solid.vertices @ turn.T
        for solid, place, turn in zip(solids, structure.position, turns, strict=True)
    ]
    found = [
        parting_normal(solids[a], corners[a], turns[a], solids[b], corners[b], turns[b]) for a, b in pairs
    ]
    return np.array(found).reshape(-1, 3)


def parting_normal(solid_a, corners_a, turn_a, solid_b, corners_b, turn_b):
    """Normal, from a to b, of the face of either convex solid that parts the two farthest, or overlaps them least.

    Parameters
    ----------
    solid_a, solid_b : Solid
    corners_a, corners_b : float64 arrays, shape (n_corners, 3)
        Their vertices in one frame [m].
    turn_a, turn_b : float64 arrays, shape (3, 3)
        From their body frames to that frame.

    Returns
    -------
    float64 array, shape (3,)
        In that frame [1]; NaN where a solid is not convex.
    """
    if solid_a.polyhedron is None or solid_b.polyhedron is None:
        return np.full(3, np.nan)
    normals = np.concatenate([solid_a.polyhedron.normals @ turn_a.T, -solid_b.polyhedron.normals @ turn_b.T])
    gaps = (corners_b @ normals.T).min(axis=0) - (corners_a @ normals.T).max(axis=0)
    return normals[gaps.argmax()]
