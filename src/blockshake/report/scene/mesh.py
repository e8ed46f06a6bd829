"""Blocks as triangles and edges in space."""

from typing import NamedTuple

import numpy as np
import trimesh

from blockshake.geometry.rotations import rotation_matrices

_SHARP = np.radians(20.0)  # of two faces whose common edge is drawn


class BodyMesh(NamedTuple):
    """A body at the start of its structure.

    Attributes
    ----------
    place : float64 array, shape (3,)
        Of the mass centre, world frame [m].
    arms : float64 array, shape (n_points, 3)
        Points of the surface seen from the mass centre, world axes [m].
    triangles, edges : int64 arrays, shape (n_triangles, 3) and (n_edges, 2)
        Rows of ``arms``; edges are those at which the surface bends.
    """

    place: np.ndarray
    arms: np.ndarray
    triangles: np.ndarray
    edges: np.ndarray


def body_mesh(structure, body):
    """`BodyMesh` of the body with this index."""
    solid = structure.solid(body)
    surface = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
    arms = solid.vertices @ rotation_matrices(structure.orientation[body]).T
    edges = surface.face_adjacency_edges[surface.face_adjacency_angles > _SHARP]
    return BodyMesh(structure.position[body], arms, solid.triangles, edges)
