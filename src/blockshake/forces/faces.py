"""Contact faces of the joints: where two bodies touch at the start, as corners that both carry along."""

from dataclasses import dataclass

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.nscd.contact.detection import detect_pair_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, pack_polyhedra, place_into

_MARGIN = 2e-4  # m, of bodies that touch at the start: twice the contract's 0.1 mm
_MOST_POINTS = 5


@dataclass(frozen=True)
class Face:
    """The face of one joint.

    Attributes
    ----------
    name : str
        ``lower-upper``.
    lower, upper : int
        Bodies, by the height of their mass centres.
    friction : float
        Coulomb's coefficient of the pair, as the structure states it [1].
    corners : float64 array, shape (n_corners, 3)
        Of the common area, from the middle of the face, in the axes of ``axes`` [m].
    on_upper : float64 array, shape (3,)
        Middle of the face from the mass centre of the upper body, in its frame [m].
    axes : float64 array, shape (3, 3)
        At the start, world frame, in columns: two tangents, the first one along x as far as the face allows, and the
        normal from the lower to the upper body.
    """

    name: str
    lower: int
    upper: int
    friction: float
    corners: np.ndarray
    on_upper: np.ndarray
    axes: np.ndarray

    @property
    def half_width(self):
        """Half the width of the common area along its first tangent [m]."""
        return 0.5 * float(np.ptp(self.corners[:, 0]))


def find_faces(structure):
    """Contact faces of a structure at its start, in the order of `find_joints`.

    Parameters
    ----------
    structure : Structure

    Returns
    -------
    list of Face

    Raises
    ------
    InputError
        A shape that is not convex.
    """
    order = np.arange(len(structure.mass))
    polyhedra = pack_polyhedra(structure, order)
    placed = empty_placed(polyhedra)
    place_into(polyhedra, structure.position, structure.orientation, placed)
    turns = rotation_matrices(structure.orientation)
    memory = np.full((len(order), len(order)), -1, np.int64)
    normal, points = np.empty(3), np.empty((_MOST_POINTS, 3))
    gaps, areas = np.empty(_MOST_POINTS), np.empty(_MOST_POINTS)
    faces = []
    for pair in np.argwhere(np.triu(structure.touching)):
        lower, upper = sorted(pair, key=lambda body: structure.centroid[body, 2])
        count = detect_pair_into(
            polyhedra, placed, lower, upper, _MARGIN, 0.0, 0.0, memory, normal, points, gaps, areas
        )
        if not count:
            continue
        middle = points[:count].mean(axis=0)
        axes = _face_axes(normal)
        names = structure.body_names
        faces.append(
            Face(
                name=f"{names[lower]}-{names[upper]}",
                lower=int(lower),
                upper=int(upper),
                friction=float(structure.friction[lower, upper]),
                corners=(points[:count] - middle) @ axes,
                on_upper=(middle - structure.position[upper]) @ turns[upper],
                axes=axes,
            )
        )
    return faces


def _face_axes(normal):
    """Two tangents and the normal, in columns; the first tangent is along x, or z on a face that looks along x."""
    along = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[2]
    first = along - (along @ normal) * normal
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(normal, first), normal])
