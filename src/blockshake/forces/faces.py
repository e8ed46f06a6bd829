"""Contact faces of the joints: where two bodies touch at the start, as corners that both carry along."""

from dataclasses import dataclass

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import contact_normals

_MARGIN = 2e-4  # m, between surfaces that touch at the start: twice the contract's 0.1 mm
_TURNED, _AS_LAID = np.cos(0.5), 1.0 - 1e-9  # cosines of turns between which a face has the axes of a box


@dataclass(frozen=True)
class Face:
    """The face of one joint."""

    name: str  # ``lower-upper``
    # lower, upper: bodies, by the height of their centroids
    lower: int
    upper: int
    friction: float  # Coulomb's coefficient of the pair, as the structure states it [1]
    # float64 (n_corners, 3); of the common area, from the middle of the face, in the axes of ``axes`` [m]
    corners: np.ndarray
    # float64 (3,); middle of the face from the mass centre of the upper body, in its frame [m]
    on_upper: np.ndarray
    # float64 (3, 3); at the start, world frame, in columns: two tangents, the first one along x as far as the
    # face allows, or along the edges of a box that is turned, and the normal from the lower to the upper body
    axes: np.ndarray

    @property
    def half_width(self):
        """Half the width of the common area along its first tangent [m]."""
        return 0.5 * float(np.ptp(self.corners[:, 0]))


def find_faces(structure):
    """Contact faces of a structure at its start, `Face` in the order of `find_joints`.

    Raises
    ------
    InputError
        A shape that is not convex.

    Notes
    -----
    The common area is that of the two polygons that look at each other, each seen along the face's normal and clipped
    by the edges of the other (Sutherland and Hodgman 1974), where they are nearer than 0.2 mm.
    """
    for name, solid in structure.solids.items():
        if solid.polyhedron is None:
            raise InputError(structure.source, f"shapes.{name}", "expected a convex shape")
    pairs = [
        sorted(pair, key=lambda body: structure.centroid[body, 2])
        for pair in np.argwhere(np.triu(structure.touching))
    ]
    faces = []
    for (lower, upper), normal in zip(pairs, contact_normals(structure, pairs), strict=True):
        axes, corners = _common_area(structure, lower, upper, normal)
        if not len(corners):
            continue
        middle = axes @ (0.5 * (corners.min(axis=0) + corners.max(axis=0)))
        names = structure.body_names
        faces.append(
            Face(
                name=f"{names[lower]}-{names[upper]}",
                lower=int(lower),
                upper=int(upper),
                friction=float(structure.friction[lower, upper]),
                corners=corners - middle @ axes,
                on_upper=(middle - structure.position[upper])
                @ rotation_matrices(structure.orientation[upper]),
                axes=axes,
            )
        )
    return faces


def _common_area(structure, lower, upper, normal):
    """Axes of a face, and corners of what it has in common: along the edges of the smaller body, if it is turned off x.

    The other body counts as if it had the same edges: a small turn against each other moves no edge at its middle.
    """
    sides = []
    for body, sign in ((lower, 1.0), (upper, -1.0)):
        axes = _face_axes(structure, body, normal)
        sides.append((axes, _outline(structure, body, sign, axes)))
    axes, _ = min(sides, key=lambda side: np.ptp(side[1][:, :2], axis=0).prod())
    places = [structure.position[body] @ axes for body in (lower, upper)]
    return axes, _common_corners(*(place + side[1] for place, side in zip(places, sides, strict=True)))


def _face_axes(structure, body, normal):
    """Two tangents and the normal, in columns.

    The first tangent is along x, or z on a face that looks along x, or along the edges of a box that is turned off it.
    """
    along = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[2]
    edges = rotation_matrices(structure.orientation[body])
    edge = edges[:, int(np.argmax(np.abs(along @ edges)))]
    box = structure.file.shapes[structure.file.bodies[body].shape].box
    if box and _TURNED < abs(along @ edge) < _AS_LAID:
        along = np.sign(along @ edge) * edge
    first = along - (along @ normal) * normal
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(normal, first), normal])


def _outline(structure, body, sign, axes):
    """Corners from its mass centre (n, 3) [m], counter-clockwise, of a body's face that looks along the last axis."""
    turn = rotation_matrices(structure.orientation[body]).T @ axes
    polyhedron = structure.solid(body).polyhedron
    face = polyhedron.faces[int(np.argmax(sign * polyhedron.normals @ turn[:, 2]))]
    corners = polyhedron.vertices[face] @ turn
    return corners if sign > 0.0 else corners[::-1]


def _common_corners(lower, upper):
    """Corners of what two outlines have in common, midway between them, where these are near each other."""
    common = upper
    for start, end in zip(lower, np.roll(lower, -1, axis=0), strict=True):
        along = end - start
        inside = along[0] * (common[:, 1] - start[1]) - along[1] * (common[:, 0] - start[0])
        kept = []
        for here, there, at, then in zip(
            common, np.roll(common, -1, axis=0), inside, np.roll(inside, -1), strict=True
        ):
            if at >= 0.0:
                kept.append(here)
            if at * then < 0.0:
                kept.append(here + at / (at - then) * (there - here))
        common = np.reshape(kept, (-1, 3))
    # the lower outline is flat: its height at the common corners
    plane = np.linalg.lstsq(np.column_stack([lower[:, :2], np.ones(len(lower))]), lower[:, 2], rcond=None)[0]
    gap = common[:, 2] - common[:, :2] @ plane[:2] - plane[2]
    return (common - 0.5 * gap[:, None] * np.eye(3)[2])[gap <= _MARGIN]
