"""The file of one measured test, netCDF or a pair of CSV tables, checked against the structure."""

import csv
import io
from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import read_text
from blockshake.measurement.markers import marker_position

AXES = ("x", "y", "z")
_FARTHEST = 20.0  # m; no table moves so far, a file in millimetres does
_OPTIONAL = {
    "marker_initial_position": {"marker", "axis"},
    "accelerometer": {"time_acc", "channel"},
    "table_displacement": {"time"},
    "initial_offset": {"body", "axis"},
    "initial_rotation": {"body", "axis"},
}


def read_test(path, structure):
    """Readings of one test.

    Parameters
    ----------
    path : str or path
        A netCDF file, or ``NAME.csv`` with columns ``time_s`` and ``MARKER.AXIS`` [m]; beside it may lie
        ``NAME-acc.csv`` with ``time_s`` and one column a channel [m/s2]. An empty cell is a gap.
    structure : Structure
        Whose markers are read.

    Returns
    -------
    xarray.Dataset
        Variables of the contract, float64; the file is never changed.

    Raises
    ------
    InputError
        Not readable, times that do not increase, unknown markers, no marker on the driven body, a channel without
        any reading, axes that are swapped, or another unit.
    """
    path = Path(path)
    test = _read_csv(path) if path.suffix == ".csv" else _read_netcdf(path)
    for name in ("time", "time_acc"):
        if name in test.coords:
            _check_times(test[name].to_numpy(), path, name)
    if tuple(test["axis"].values) != AXES:
        test = _ordered_axes(test, path)
    _check_markers(test, structure, path)
    _check_readings(test, path)
    _check_places(test, structure, path)
    return test


def _read_netcdf(path):
    try:
        test = xr.load_dataset(path)
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(path, "", f"expected a netCDF file; {error}") from None
    dimensions = {"marker_displacement": {"time", "marker", "axis"}, **_OPTIONAL}
    for name, expected in dimensions.items():
        if name in test and set(test[name].dims) != expected:
            raise InputError(path, name, f"expected the dimensions {', '.join(sorted(expected))}")
    if "marker_displacement" not in test:
        raise InputError(path, "marker_displacement", "expected displacements over time, marker and axis")
    for name in ("time", "marker", "axis"):
        if name not in test.coords:
            raise InputError(path, name, "expected this coordinate")
    known = [name for name in dimensions if name in test]
    return test[known].transpose("time", "marker", "axis", ...).astype(np.float64)


def _read_csv(path):
    time, columns = _table(path)
    markers = list(dict.fromkeys(name.rpartition(".")[0] for name in columns))
    values = np.full((len(time), len(markers), 3), np.nan)
    for name, column in columns.items():
        marker, _, axis = name.rpartition(".")
        if axis not in AXES or not marker:
            raise InputError(path, name, "expected columns MARKER.x, MARKER.y, MARKER.z")
        values[:, markers.index(marker), AXES.index(axis)] = column
    variables = {"marker_displacement": (("time", "marker", "axis"), values, {"units": "m"})}
    coordinates = {"time": time, "marker": markers, "axis": list(AXES)}
    beside = path.with_name(f"{path.stem}-acc.csv")
    if beside.is_file():
        time_acc, channels = _table(beside)
        variables["accelerometer"] = (
            ("time_acc", "channel"), np.column_stack(list(channels.values())), {"units": "m s-2"},
        )  # fmt: skip
        coordinates |= {"time_acc": time_acc, "channel": list(channels)}
    return xr.Dataset(variables, coordinates)


def _table(path):
    """Times and columns of a CSV; empty cells are NaN."""
    rows = [row for row in csv.reader(io.StringIO(read_text(path).removeprefix("\ufeff"))) if any(row)]
    names = [name.strip() for name in rows[0]] if rows else []
    if "time_s" not in names or len(rows) < 2 or len(set(names)) < len(names):
        raise InputError(
            path, "time_s", "expected a header with time_s and every name once, and rows below it"
        )
    values = np.empty((len(rows) - 1, len(names)))
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            raise InputError(path, f"line {line}", f"expected {len(names)} cells, not {len(row)}")
        for column, cell in enumerate(row):
            try:
                values[line - 2, column] = float(cell) if cell.strip() else np.nan
            except ValueError:
                raise InputError(
                    path,
                    f"line {line}, {names[column]}",
                    f"expected a number or nothing, not '{cell.strip()}'",
                ) from None
    time = values[:, names.index("time_s")]
    return time, {name: values[:, place] for place, name in enumerate(names) if name != "time_s"}


def _check_times(time, path, name):
    if len(time) < 2 or not np.isfinite(time).all():
        raise InputError(path, name, "expected at least two times, all finite")
    steps = np.diff(time)
    if not (steps > 0.0).all():
        place = int(np.argmin(steps > 0.0))
        raise InputError(
            path, name, f"expected times that increase; {time[place + 1]:g} s follows {time[place]:g} s"
        )


def _ordered_axes(test, path):
    if sorted(map(str, test["axis"].values)) != list(AXES):
        raise InputError(path, "axis", f"expected x, y, z, not {', '.join(map(str, test['axis'].values))}")
    return test.sel(axis=list(AXES))


def _check_markers(test, structure, path):
    bodies = {marker.name: marker.body for marker in structure.file.markers}
    read = [str(name) for name in test["marker"].values]
    for name in read:
        if name not in bodies:
            raise InputError(path, name, f"expected markers of the structure: {', '.join(bodies)}")
        if read.count(name) > 1:
            raise InputError(path, name, "expected every marker once")
    driven = {body.name for body in structure.file.bodies if body.driven}
    if not any(bodies[name] in driven for name in read):
        wanted = [name for name, body in bodies.items() if body in driven]
        raise InputError(
            path, "marker", f"expected a marker of the driven body, which is the input: {' or '.join(wanted)}"
        )


def _check_readings(test, path):
    displacement = test["marker_displacement"]
    silent = displacement.isnull().all("time").to_numpy()
    if silent.any():
        marker, axis = np.argwhere(silent)[0]
        raise InputError(
            path,
            f"{displacement['marker'].values[marker]}.{AXES[axis]}",
            "expected readings; all are missing",
        )
    if (
        "accelerometer" in test
        and (silent := test["accelerometer"].isnull().all("time_acc").to_numpy()).any()
    ):
        raise InputError(
            path, str(test["channel"].values[np.argmax(silent)]), "expected readings; all are missing"
        )
    farthest = float(np.abs(displacement).max())
    if farthest > _FARTHEST:
        raise InputError(
            path,
            "marker_displacement",
            f"expected metres; a displacement of {farthest:g} looks like millimetres",
        )


def _check_places(test, structure, path):
    """Where the file says where markers started, they must start where the structure has them."""
    if "marker_initial_position" not in test:
        return
    places = marker_position(structure, structure.position, structure.orientation)
    own = {marker.name: place for marker, place in zip(structure.file.markers, places, strict=True)}
    nominal = np.array([own[str(name)] for name in test["marker"].values])
    read = test["marker_initial_position"].transpose("marker", "axis").to_numpy()
    known = np.isfinite(read).all(axis=1)
    away = np.linalg.norm(read - nominal, axis=1)[known]
    if not len(away) or away.max() < 0.1:
        return
    for order in ((1, 0, 2), (2, 1, 0), (0, 2, 1), (1, 2, 0), (2, 0, 1)):
        if np.linalg.norm(read[:, order] - nominal, axis=1)[known].max() < 0.1:
            swapped = ", ".join(AXES[place] for place in order)
            raise InputError(
                path,
                "axis",
                f"expected x, y, z; the markers start where the structure has them in the order {swapped}",
            )
    name = test["marker"].values[known][int(away.argmax())]
    raise InputError(
        path,
        f"marker_initial_position.{name}",
        f"expected it within 0.1 m of the structure's, not {away.max():.3g} m off",
    )
