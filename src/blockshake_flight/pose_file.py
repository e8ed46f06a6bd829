"""The file of one test of poses: position and orientation of one body over time."""

from pathlib import Path

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.campaigns.reading_files import read_columns, read_variables
from blockshake.measurement.campaigns.recorded_test import FARTHEST, check_times
from blockshake.measurement.motion.pose_columns import QUATERNION, free_body, poses_of_columns, rotations

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
    return test["time"].to_numpy(), position, rotations(quaternion, path, name), False


def _from_table(path, name):
    time, columns = read_columns(path)
    return (time, *poses_of_columns(columns, path, name))


def _check_turning(time, rotation, path, name):
    read = np.isfinite(rotation).all(axis=(1, 2))
    if read.sum() < 2:
        raise InputError(path, name, "expected poses in at least two rows")
    turned = Rotation.from_matrix(rotation[read])
    rate = np.linalg.norm((turned[1:] * turned[:-1].inv()).as_rotvec(), axis=1) / np.diff(time[read])
    if np.median(rate) > _FASTEST:
        wrong = f"expected rotations in radians, not a body that turns with {np.median(rate):.3g} rad/s"
        raise InputError(path, name, wrong)
