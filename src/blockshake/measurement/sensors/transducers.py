"""Readings of displacement transducers: how far a body moves from another one, along a wire or along a rod."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure_file import signed_axis
from blockshake.measurement.sensors.markers import point_position

NOISE = 1e-4  # m, standard deviation of the readings where nothing else is stated
_LOST = 0.5  # cosine of the angle between rod and face's normal below which the rod has lost the face


class Reach(NamedTuple):
    """How far a transducer reaches, and how that grows with the motion of its end at the body.

    ``length``: float64 (n_times,) [m]. ``pull``: its derivative with respect to the end's position, inertial frame,
    float64 (n_times, 3) [1]; that with respect to the anchor's position is the opposite.
    """

    length: np.ndarray
    pull: np.ndarray


def transducer_names(structure):
    """Names of the displacement transducers in file order, list of str."""
    return [item.name for item in structure.file.displacement_transducers]


def transducer_lengths(structure, position, orientation):
    """Length of every displacement transducer; a reading is its change since the start.

    Parameters
    ----------
    structure : Structure
    position : float64 array, shape (n_times, n_bodies, 3)
        Places of the mass centres, inertial frame [m].
    orientation : float64 array, shape (n_times, n_bodies, 4)
        Unit quaternions (w, x, y, z), body to world.

    Returns
    -------
    float64 array, shape (n_times, n_transducers)
        From a datum that is the same at all times [m]; NaN where a pose is, and where a rod has lost its face.
    """
    items = structure.file.displacement_transducers
    ends = point_position(structure, items, position, orientation)
    anchors = point_position(structure, [item.anchor for item in items], position, orientation)
    readings = np.empty(ends.shape[:2])
    for index, item in enumerate(items):
        body, carrier = (structure.body_names.index(name) for name in (item.body, item.reference))
        turn, carrier_turn = (rotation_matrices(orientation[:, number]) for number in (body, carrier))
        readings[:, index] = reach(
            structure, item, ends[:, index] - anchors[:, index], turn, carrier_turn
        ).length
    return readings


def reach(structure, transducer, gap, turn, carrier_turn):
    """`Reach` of one transducer.

    Parameters
    ----------
    structure : Structure
        At its start rods stand square to their faces.
    transducer : DisplacementTransducer
    gap : float64 array, shape (n_times, 3)
        From the anchor to the end at the body, inertial frame [m].
    turn, carrier_turn : float64 arrays, shape (n_times, 3, 3)
        Rotations of the body and of the reference, body to world.

    Notes
    -----
    The wire of a cable-extension transducer (string potentiometer, draw wire) is drawn tight by a spring and reads the
    distance of its two ends: sideways motion ``s`` of one end lengthens it by ``s^2 / (2 length)``. The plunger of a
    spring-loaded linear transducer (LVDT, rod potentiometer) slides in its housing along an axis a that the reference
    carries, and bears on the body's plane face with normal n: ``n . gap / (n . a)``, so that the body may slide along
    the face unread. Their kinematics, by definition; these are the two kinds of a shake table's relative displacements.
    """
    if transducer.axis is None:
        length = np.linalg.norm(gap, axis=1)
        return Reach(length, gap / length[:, None])
    start = rotation_matrices(
        structure.orientation[
            [structure.body_names.index(name) for name in (transducer.body, transducer.reference)]
        ]
    )
    axis = signed_axis(transducer.axis)
    along, normal = carrier_turn @ axis, turn @ (start[0].T @ start[1] @ axis)
    cosine = (normal * along).sum(axis=1)
    pull = normal / np.where(cosine > _LOST, cosine, np.nan)[:, None]
    return Reach((pull * gap).sum(axis=1), pull)
