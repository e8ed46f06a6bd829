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

    Notes
    -----
    Of all normals of faces of the two, the normal taken parts them the farthest, or overlaps them the least.
    """
    turns = rotation_matrices(structure.orientation)
    solids = [structure.solid(body) for body in range(len(structure.mass))]
    found = np.full((len(pairs), 3), np.nan)
    for place, (first, second) in enumerate(pairs):
        if solids[first].polyhedron is None or solids[second].polyhedron is None:
            continue
        normals = np.concatenate(
            [
                solids[first].polyhedron.normals @ turns[first].T,
                -solids[second].polyhedron.normals @ turns[second].T,
            ]
        )
        ends = [
            (structure.position[body] + solids[body].vertices @ turns[body].T) @ normals.T
            for body in (first, second)
        ]
        found[place] = normals[np.argmax(ends[1].min(axis=0) - ends[0].max(axis=0))]
    return found
