"""Blocks as faces in space, and their colours: one a material, grey for driven bodies, apart in a grey print too."""

from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_rgb

from blockshake.geometry.rotations import rotation_matrices

_MATERIALS = ("#cfd8dc", "#f2d6a2", "#b9d7ea", "#c9dfb8")
_DRIVEN = "#b0b0b0"


class BodyMesh(NamedTuple):
    """A body at the start of its structure."""

    place: np.ndarray  # float64 (3,); of the mass centre, world frame [m]
    arms: np.ndarray  # float64 (n_points, 3); points of the surface seen from the mass centre, world axes [m]
    faces: list  # of lists of int; rows of ``arms``, outward; triangles where the shape is not convex


def body_mesh(structure, body):
    """`BodyMesh` of the body with this index."""
    solid = structure.solid(body)
    faces = solid.triangles if solid.polyhedron is None else solid.polyhedron.faces
    arms = solid.vertices @ rotation_matrices(structure.orientation[body]).T
    return BodyMesh(structure.position[body], arms, [list(map(int, face)) for face in faces])


def body_colors(structure):
    """Red, green and blue of every body of a structure, float64 array, shape (n_bodies, 3)."""
    materials = list(structure.file.materials)
    return np.array(
        [
            to_rgb(_DRIVEN if body.driven else _MATERIALS[materials.index(body.material) % len(_MATERIALS)])
            for body in structure.file.bodies
        ]
    )
