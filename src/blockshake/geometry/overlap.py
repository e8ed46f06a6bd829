"""How deep two solids overlap, by the separating-axis theorem on their convex hulls."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices


def penetration_depth(solid_a, position_a, orientation_a, solid_b, position_b, orientation_b):
    """Depth of overlap of two convex solids along the axis of least overlap.

    Parameters
    ----------
    solid_a, solid_b : Solid
        Shapes about their mass centres.
    position_a, position_b : float64 arrays, shape (3,)
        Mass centres, world frame [m].
    orientation_a, orientation_b : float64 arrays, shape (4,)
        Unit quaternions (w, x, y, z), body to world.

    Returns
    -------
    float
        Depth [m]; negative is a lower bound of the clearance. Zero for a pair with a
        shape that is not convex, whose overlap this test cannot tell.
    """
    radius_a = np.linalg.norm(solid_a.vertices, axis=1).max()
    radius_b = np.linalg.norm(solid_b.vertices, axis=1).max()
    distance = np.linalg.norm(position_b - position_a)
    if distance > radius_a + radius_b:
        return radius_a + radius_b - distance
    if solid_a.polyhedron is None or solid_b.polyhedron is None:
        return 0.0
    rotation_a, rotation_b = rotation_matrices(orientation_a), rotation_matrices(orientation_b)
    points_a = solid_a.vertices @ rotation_a.T
    points_b = solid_b.vertices @ rotation_b.T + (position_b - position_a)
    axes_a = solid_a.polyhedron.normals @ rotation_a.T
    axes_b = solid_b.polyhedron.normals @ rotation_b.T
    edges_a = _edge_directions(solid_a.polyhedron) @ rotation_a.T
    edges_b = _edge_directions(solid_b.polyhedron) @ rotation_b.T
    crosses = np.cross(edges_a[:, None], edges_b[None]).reshape(-1, 3)
    lengths = np.linalg.norm(crosses, axis=1)
    crosses = crosses[lengths > 1e-6] / lengths[lengths > 1e-6, None]
    axes = np.vstack([axes_a, axes_b, crosses])
    along_a, along_b = points_a @ axes.T, points_b @ axes.T
    overlap = np.minimum(along_a.max(axis=0) - along_b.min(axis=0), along_b.max(axis=0) - along_a.min(axis=0))
    return float(overlap.min())


def _edge_directions(polyhedron):
    edges = np.concatenate(
        [polyhedron.vertices[np.roll(face, -1)] - polyhedron.vertices[face] for face in polyhedron.faces]
    )
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    edges *= np.where(edges[np.arange(len(edges)), np.abs(edges).argmax(axis=1)] < 0.0, -1.0, 1.0)[:, None]
    return np.unique(np.round(edges, 9), axis=0)
