"""Columns of a body's pose, position and orientation over time, as programs of tracking export them."""

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES

QUATERNION = ("w", "x", "y", "z")
ANGLE = "angle_y"  # rad, right-handed about +y: of a body that is filmed in the plane of x and z
_LENGTH_ERROR = 0.01  # by which the length of a quaternion may differ from 1


def free_body(structure):
    """Indices of the one free body and of the one driven body, the ground.

    Raises
    ------
    InputError
        More or fewer bodies, a ground that is not level, a free body that is not convex.
    """
    free, driven = np.flatnonzero(~structure.driven), np.flatnonzero(structure.driven)
    if len(free) != 1 or len(driven) != 1:
        raise InputError(
            structure.source, "bodies",
            "expected one free body and one driven body, the ground, in a campaign without base motion; "
            f"found {len(free)} and {len(driven)}",
        )  # fmt: skip
    if not np.allclose(structure.orientation[driven[0]], (1.0, 0.0, 0.0, 0.0)):
        raise InputError(structure.source, structure.body_names[driven[0]], "expected a level ground")
    if structure.solid(free[0]).polyhedron is None:
        raise InputError(structure.source, structure.body_names[free[0]], "expected a convex body")
    return int(free[0]), int(driven[0])


def poses_of_columns(columns, path, name):
    """Position (n_times, 3) [m], rotation (n_times, 3, 3) and whether it is planar, from the columns of a body.

    ``columns``: float64 arrays (n_times,) by ``BODY.x`` and the like, as in `read_poses`; ``path`` is the file that an
    error names.

    Raises
    ------
    InputError
        A column that is missing or unknown, a quaternion that is not of unit length.
    """
    position = np.full((len(next(iter(columns.values()))), 3), np.nan)
    for number, axis in enumerate(AXES):
        if f"{name}.{axis}" in columns:
            position[:, number] = columns[f"{name}.{axis}"]
    turned = f"{name}.{ANGLE}"
    whole = [f"{name}.q{one}" for one in QUATERNION]
    wanted = [f"{name}.x", f"{name}.z", *([turned] if turned in columns else whole)]
    for key in wanted:
        if key not in columns:
            raise InputError(path, key, f"missing column; expected {', '.join(wanted)}, or {turned}")
    if turned in columns and any(key in columns for key in whole):
        raise InputError(path, turned, "expected an angle or a quaternion, not both")
    known = {f"{name}.{axis}" for axis in AXES} | {turned, *whole}
    for key in columns:
        if key.startswith(f"{name}.") and key not in known:
            raise InputError(path, key, f"expected one of {', '.join(sorted(known))}")
    if turned in columns:
        return position, _about_y(columns[turned]), True
    return position, rotations(np.column_stack([columns[key] for key in whole]), path, name), False


def _about_y(angle):
    rotation = np.full((len(angle), 3, 3), np.nan)
    read = np.isfinite(angle)
    rotation[read] = Rotation.from_euler("y", angle[read, None]).as_matrix()
    return rotation


def rotations(quaternion, path, name):
    """Rotation matrices of unit quaternions; a jump of all four signs turns nothing."""
    rotation = np.full((len(quaternion), 3, 3), np.nan)
    read = np.isfinite(quaternion).all(axis=1)
    length = np.linalg.norm(quaternion[read], axis=1)
    if (np.abs(length - 1.0) > _LENGTH_ERROR).any():
        row = int(np.flatnonzero(read)[np.abs(length - 1.0).argmax()])
        off = f"{np.linalg.norm(quaternion[row]):.3g} in row {row + 1}"
        raise InputError(path, f"{name}.q", f"expected unit quaternions, not of length {off}")
    rotation[read] = Rotation.from_quat(quaternion[read], scalar_first=True).as_matrix()
    return rotation
