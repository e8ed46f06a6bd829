"""Joints of a structure: where they are, their normals, and the motion of the upper block against the lower one."""

from itertools import takewhile

import numpy as np
import xarray as xr
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES

# dimensions, unit and name of the coordinates of a joint
_COORDINATES = {
    "slip": ("time joint tangent", "m", "slip of the upper body at the joint's centre, lower body's frame"),
    "opening": ("time joint", "m", "opening at the joint's centre, lower body's frame"),
    "rotation": ("time joint axis", "rad", "rotation of the upper body against the lower one, its frame"),
}


def find_joints(structure):
    """Joints of a structure at its start.

    Returns
    -------
    pairs : int64 array, shape (n_joints, 2)
        Lower body, upper body, by height of their centroids.
    centres : float64 array, shape (n_joints, 3)
        Middle of what the bounding boxes of the two have in common, world frame [m].
    """
    low, high = [], []
    for body in range(len(structure.mass)):
        turn = rotation_matrices(structure.orientation[body])
        corners = structure.position[body] + structure.solid(body).vertices @ turn.T
        low.append(corners.min(axis=0))
        high.append(corners.max(axis=0))
    low, high = np.array(low), np.array(high)
    pairs = np.argwhere(np.triu(structure.touching))
    height = structure.centroid[:, 2]
    swapped = height[pairs[:, 0]] > height[pairs[:, 1]]
    pairs[swapped] = pairs[swapped][:, ::-1]
    first, second = pairs.T
    centres = 0.5 * (np.maximum(low[first], low[second]) + np.minimum(high[first], high[second]))
    return pairs, centres


def find_leaves(structure):
    """Blocks that joints hold together, such as a leaf of a wall: indices of the bodies by the name of the leaf.

    The name is the words, between hyphens, that the names of its blocks begin with; where these tell it from no other,
    the first and the last block.
    """
    _, group = connected_components(structure.touching & ~structure.driven[:, None] & ~structure.driven)
    free = np.flatnonzero(~structure.driven)
    leaves = [free[group[free] == one] for one in dict.fromkeys(group[free].tolist())]
    names = [[structure.body_names[body] for body in leaf] for leaf in leaves]
    words = [zip(*(name.split("-") for name in one), strict=False) for one in names]
    begin = ["-".join(row[0] for row in takewhile(lambda row: len(set(row)) == 1, rows)) for rows in words]
    distinct = all(begin) and len(set(begin)) == len(begin)
    ends = (" to ".join(dict.fromkeys((one[0], one[-1]))) for one in names)
    return dict(zip(begin if distinct else ends, leaves, strict=True))


def joint_coordinates(structure, position, rotation):
    """Slip, opening and rotation of every joint since the first time.

    Parameters
    ----------
    structure : Structure
    position : float64 array, shape (n_times, n_bodies, 3)
        Places of the mass centres, inertial frame [m].
    rotation : float64 array, shape (n_times, n_bodies, 3, 3)
        Body to world.

    Returns
    -------
    xarray.Dataset
        In the lower body's frame, of the upper body at the joint's centre: ``slip(time, joint, tangent)`` along x and
        y, ``opening(time, joint)`` along z [m], and ``rotation(time, joint, axis)``, the rotation vector of the
        upper body [rad]. Coordinates ``joint`` (``lower-upper``), ``lower`` and ``upper``; time is not named.

    Raises
    ------
    InputError
        The structure has no joints.

    Notes
    -----
    The centre is a point of the upper body; a block that rocks about its edge opens there by half its width times
    the angle and slips by next to nothing.
    """
    pairs, centres = find_joints(structure)
    if not len(pairs):
        raise InputError(structure.source, "bodies", "expected bodies that touch")
    lower, upper = pairs.T
    arm_upper = np.einsum("jki,jk->ji", rotation[0, upper], centres - position[0, upper])
    point = position[:, upper] + np.einsum("tjik,jk->tji", rotation[:, upper], arm_upper)
    seen = np.einsum("tjki,tjk->tji", rotation[:, lower], point - position[:, lower])
    moved = seen - seen[:1]
    turned = np.einsum("tjki,tjkl->tjil", rotation[:, lower], rotation[:, upper])
    turned = np.einsum("tjik,jlk->tjil", turned, turned[0])
    names = structure.body_names
    values = {"slip": moved[..., :2], "opening": moved[..., 2], "rotation": rotation_vectors(turned)}
    return xr.Dataset(
        {
            name: (dims.split(), values[name], {"long_name": long_name, "units": unit})
            for name, (dims, unit, long_name) in _COORDINATES.items()
        },
        coords={
            "joint": [f"{names[a]}-{names[b]}" for a, b in pairs],
            "lower": ("joint", [names[a] for a in lower]),
            "upper": ("joint", [names[b] for b in upper]),
            "tangent": ["x", "y"],
            "axis": list(AXES),
        },
    )


def rotation_vectors(matrices):
    """Rotation vectors of matrices, (..., 3); NaN where a matrix is."""
    vectors = np.full(matrices.shape[:-1], np.nan)
    known = np.isfinite(matrices).all(axis=(-2, -1))
    if known.any():
        vectors[known] = Rotation.from_matrix(matrices[known]).as_rotvec()
    return vectors


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
        centre + solid.vertices @ turn.T
        for solid, centre, turn in zip(solids, structure.position, turns, strict=True)
    ]
    normals = [
        parting_normal(solids[a], corners[a], turns[a], solids[b], corners[b], turns[b]) for a, b in pairs
    ]
    return np.array(normals).reshape(-1, 3)


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
