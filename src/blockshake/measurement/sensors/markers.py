"""Readings of the optical system: points fixed to bodies, in the inertial frame."""

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices

RATE = 200.0  # Hz, of the readings of the optical system
NOISE = 1e-4  # m, standard deviation of its readings where nothing else is stated


def marker_position(structure, position, orientation):
    """Position of every marker.

    Parameters
    ----------
    structure : Structure
    position : float64 array, shape (..., n_bodies, 3)
        Places of the mass centres, inertial frame [m].
    orientation : float64 array, shape (..., n_bodies, 4)
        Unit quaternions (w, x, y, z), body to world.

    Returns
    -------
    float64 array, shape (..., n_markers, 3)
        Inertial frame [m], markers in file order; NaN where the body's pose is.
    """
    return point_position(structure, structure.file.markers, position, orientation)


def point_position(structure, points, position, orientation):
    """Positions, as by `marker_position`, of entries of the structure file that have a ``body`` and a ``position``."""
    bodies = structure.carriers(points)
    turn = rotation_matrices(orientation[..., bodies, :])
    return position[..., bodies, :] + np.einsum("...mij,mj->...mi", turn, structure.arms(points))


def noisy_reading(displacement, marker_noise, generator):
    """Displacement as read by markers with noise, relative to the first reading.

    Parameters
    ----------
    displacement : float64 array, shape (n_times, ...)
        True, since the first time [m]; NaN stays.
    marker_noise : float
        Standard deviation of the position read, independent in time, marker and axis [m].
    generator : numpy.random.Generator
        Source of the noise; advanced.

    Returns
    -------
    float64 array, same shape
        Zero at the first time: the first reading's own error is in all the others.
    """
    position = displacement + generator.normal(0.0, marker_noise, size=np.shape(displacement))
    return position - position[:1]


def directions_read(displacement):
    """Directions that each marker of a test measures, bool (n_markers, 3).

    Parameters
    ----------
    displacement : float64 array, shape (n_times, n_markers, 3)
        Readings of a test or of a part of it [m]; NaN is a gap. A direction without any reading was not measured. A
        marker without any reading is lost for the moment, and counts as measured.
    """
    read = np.isfinite(displacement).any(axis=0)
    return read | ~read.any(axis=1, keepdims=True)


def unread_directions(test):
    """Directions that a test does not measure: list of (marker, axis)."""
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    unread = ~directions_read(displacement.to_numpy())
    names, axes = displacement["marker"].values, displacement["axis"].values
    return [(str(names[marker]), str(axes[axis])) for marker, axis in np.argwhere(unread)]


def whole_markers(test):
    """Names of the markers of a test that measure all three directions, list of str."""
    partial = {marker for marker, _ in unread_directions(test)}
    return [name for name in map(str, test["marker"].values) if name not in partial]


def marker_bodies(structure, names):
    """Names of the bodies that carry these markers, list of str."""
    bodies = {marker.name: marker.body for marker in structure.file.markers}
    return [bodies[str(name)] for name in names]


def driven_names(structure):
    """Names of the driven bodies, set of str."""
    return {body.name for body in structure.file.bodies if body.driven}


def on_driven(structure, names):
    """Whether each of these markers sits on a driven body, bool (n_markers,)."""
    return np.isin(marker_bodies(structure, names), list(driven_names(structure)))


def block_markers(structure):
    """One marker a block, body to marker: the one named ``BODY-face``, or the first where no block has such a one."""
    driven = driven_names(structure)
    markers = [marker for marker in structure.file.markers if marker.body not in driven]
    faces = [marker for marker in markers if marker.name.endswith("-face")]
    chosen = {}
    for marker in faces or markers:
        chosen.setdefault(marker.body, marker.name)
    return chosen


def driven_marker(structure, names=None):
    """Name of the first marker on a driven body, among ``names`` where given: the paper's slab marker.

    Raises
    ------
    InputError
        No driven body carries a marker.
    """
    driven = driven_names(structure)
    for marker in structure.file.markers:
        if marker.body in driven and (names is None or marker.name in names):
            return marker.name
    raise InputError(structure.source, "markers", "expected a marker on a driven body")


def slab_displacement(test, structure):
    """Mean displacement of the driven body's markers, as far as they were read, (n_times, 3) [m]; NaN is a gap."""
    readings = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    return mean_read(readings[:, on_driven(structure, test["marker"].values)])


def mean_read(readings):
    """Mean along the second axis of the readings that are there; NaN where there is none."""
    known = np.isfinite(readings)
    with np.errstate(invalid="ignore"):
        return np.where(known, readings, 0.0).sum(axis=1) / known.sum(axis=1)
