"""The file of one test of poses: position and orientation of one body over time."""

from pathlib import Path

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.campaigns.reading_files import read_columns, read_variables
from blockshake.measurement.campaigns.recorded_test import FARTHEST, check_times

QUATERNION = ("w", "x", "y", "z")
ANGLE = "angle_y"  # rad, right-handed about +y: of a body that is filmed in the plane of x and z
_LENGTH_ERROR = 0.01  # by which the length of a quaternion may differ from 1
_FASTEST = 100.0  # rad/s, of a median turning rate: degrees are 57 times as many
_VARIABLES = {
    "position": (("time", "body", "axis"), ("m", "metre", "metres", "meter", "meters")),
    "orientation": (("time", "body", "quaternion"), ("1", "")),
}


def read_poses(path, structure):
    """Poses of the free body of a structure.

    Parameters
    ----------
    path : str or path
        A netCDF file with ``position(time, body, axis)`` [m] of the shape's centroid and ``orientation(time, body,
        quaternion)`` (w, x, y, z), body to world, as in a run file; or a CSV table with ``time_s``, ``BODY.x`` and the
        like [m], and ``BODY.qw`` to ``BODY.qz`` or, of a motion in the plane of x and z, ``BODY.angle_y`` [rad].
        An empty cell is a gap. Other bodies in the file are not read.
    structure : Structure
        With one free body, see `free_body`.

    Returns
    -------
    xarray.Dataset
        ``position(time, axis)`` [m], NaN along an axis that was not filmed, and ``rotation(time, axis, column)``, body
        to world; NaN in gaps. Times count from the first row. ``planar`` in its attributes.

    Raises
    ------
    InputError
        Not readable, no pose of the body, times that do not increase, a quaternion that is not of unit length, lengths
        that are not metres, angles that are not radians.
    """
    path, (body, _) = Path(path), free_body(structure)
    name = structure.body_names[body]
    read = _from_table(path, name) if path.suffix.lower() == ".csv" else _from_netcdf(path, name)
    time, position, rotation, planar = read
    check_times(time, path, "time")
    for axis in (0, 2):
        if np.isnan(position[:, axis]).all():
            raise InputError(path, f"{name}.{AXES[axis]}", "expected readings; all are missing")
    if np.nanmax(np.abs(position), initial=0.0) > FARTHEST:
        raise InputError(path, f"{name}.x", f"expected metres, not {np.nanmax(np.abs(position)):.4g}")
    _check_turning(time, rotation, path, name)
    return xr.Dataset(
        {"position": (("time", "axis"), position), "rotation": (("time", "axis", "column"), rotation)},
        {"time": time - time[0], "axis": list(AXES)},
        {"planar": planar},
    )


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


def _from_netcdf(path, name):
    test = read_variables(path, _VARIABLES)
    for variable in _VARIABLES:
        if variable not in test:
            raise InputError(path, variable, f"expected {variable} over {', '.join(_VARIABLES[variable][0])}")
    if name not in test["body"].values:
        raise InputError(path, "body", f"expected {name} of the structure")
    own = test.sel(body=name)
    position = own["position"].sel(axis=list(AXES)).transpose("time", "axis").to_numpy()
    quaternion = (
        own["orientation"].sel(quaternion=list(QUATERNION)).transpose("time", "quaternion").to_numpy()
    )
    return test["time"].to_numpy(), position, _rotations(quaternion, path, name), False


def _from_table(path, name):
    time, columns = read_columns(path)
    return (time, *poses_of_columns(columns, path, name))


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
    return position, _rotations(np.column_stack([columns[key] for key in whole]), path, name), False


def _about_y(angle):
    rotation = np.full((len(angle), 3, 3), np.nan)
    read = np.isfinite(angle)
    rotation[read] = Rotation.from_euler("y", angle[read, None]).as_matrix()
    return rotation


def _rotations(quaternion, path, name):
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


def _check_turning(time, rotation, path, name):
    read = np.isfinite(rotation).all(axis=(1, 2))
    if read.sum() < 2:
        raise InputError(path, name, "expected poses in at least two rows")
    turned = Rotation.from_matrix(rotation[read])
    rate = np.linalg.norm((turned[1:] * turned[:-1].inv()).as_rotvec(), axis=1) / np.diff(time[read])
    if np.median(rate) > _FASTEST:
        wrong = f"expected rotations in radians, not a body that turns with {np.median(rate):.3g} rad/s"
        raise InputError(path, name, wrong)
