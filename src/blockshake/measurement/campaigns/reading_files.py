"""Readings of a test as its file has them: netCDF, or a pair of CSV tables."""

import io

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.interrupts import delayed_interrupts
from blockshake.paths import file_below
from blockshake.tables.damaged_hdf5 import DAMAGE, has_endless_heap
from blockshake.tables.table_file import TableLayout, read_table

_METRES = ("m", "metre", "metres", "meter", "meters")
_ACCELERATION = ("m s-2", "m s^-2", "m s**-2", "m/s2", "m/s^2", "m/s**2", "m.s-2", "meters/second^2")
_RADIANS = ("rad", "radian", "radians")
_SECONDS = ("s", "sec", "second", "seconds")
_VARIABLES = {
    "marker_displacement": (("time", "marker", "axis"), _METRES),
    "marker_initial_position": (("marker", "axis"), _METRES),
    "accelerometer": (("time_acc", "channel"), _ACCELERATION),
    "transducer_displacement": (("time_acc", "transducer"), _METRES),
    "table_displacement": (("time",), _METRES),
    "initial_offset": (("body", "axis"), _METRES),
    "initial_rotation": (("body", "axis"), _RADIANS),
}
SURVEY = {name: _VARIABLES[name] for name in _VARIABLES if "initial" in name}
_CLASSIC = (b"CDF\x01", b"CDF\x02")  # whose missing end the netCDF library reads as zeros, and scipy refuses


def read_netcdf(path):
    """Variables of a test in a netCDF file, float64, in the order of dimensions of docs/guide/campaigns.md.

    Raises
    ------
    InputError
        No netCDF, readings or coordinates missing, other dimensions, no numbers, another unit than SI stated.
    """
    test = read_variables(path, _VARIABLES)
    if "marker_displacement" not in test:
        raise InputError(path, "marker_displacement", "expected displacements over time, marker and axis")
    return test.transpose("time", "marker", "axis", ...)


def read_variables(path, variables):
    """Variables that a netCDF file has, of those named, float64 with float64 times.

    Parameters
    ----------
    path : Path
    variables : dict of str to (tuple of str, tuple of str)
        By name: dimensions, and words for its unit.
    """
    test = _dataset(path)
    known = [name for name in variables if name in test]
    for name in known:
        _check_variable(test, name, path, *variables[name])
    test = test[known].astype(np.float64)
    return test.assign_coords(
        {
            name: (name, test[name].to_numpy().astype(np.float64), test[name].attrs)
            for name in ("time", "time_acc")
            if name in test.coords
        }
    )


def _dataset(path):
    try:
        content = path.read_bytes()
        if content[:4] in _CLASSIC:
            return xr.load_dataset(io.BytesIO(content), engine="scipy", decode_times=False)
        if has_endless_heap(path):
            raise ValueError
        with delayed_interrupts():
            return xr.load_dataset(path, decode_times=False)
    except DAMAGE:
        raise InputError(path, "", "expected a netCDF file; this is cut, damaged or something else") from None


def _check_variable(test, name, path, dimensions, units):
    if set(test[name].dims) != set(dimensions):
        raise InputError(path, name, f"expected the dimensions {', '.join(dimensions)}")
    for dimension in dimensions:
        if dimension not in test.coords:
            raise InputError(path, dimension, f"expected this coordinate, which {name} needs")
        if dimension in ("time", "time_acc"):
            _check_numbers(test[dimension], path, _SECONDS)
    _check_numbers(test[name], path, units)


def _check_numbers(variable, path, units):
    """Refuse what is no number, or states that its unit is another."""
    if variable.dtype.kind not in "iuf":
        raise InputError(path, variable.name, f"expected numbers, not {variable.dtype}")
    stated = str(variable.attrs.get("units", "")).strip()
    if stated and stated not in units:
        raise InputError(path, f"{variable.name}.units", f"expected {units[0]}, not '{stated}'")


def read_tables(path, transducers):
    """Variables of a test, as by `read_netcdf`, from ``NAME.csv`` and, where it lies with, ``NAME-acc.csv``.

    Parameters
    ----------
    path : Path
    transducers : sequence of str
        Columns of ``NAME-acc.csv`` that are readings of displacement transducers [m]; others are channels [m/s2].

    Raises
    ------
    InputError
        A table without times or readings, a cell that is no number, a column that is empty or names no marker and axis.
    """
    time, columns = read_columns(path)
    markers = list(dict.fromkeys(name.rpartition(".")[0] for name in columns))
    values = np.full((len(time), len(markers), 3), np.nan)
    for name, column in columns.items():
        marker, _, axis = name.rpartition(".")
        if axis not in AXES or not marker:
            raise InputError(path, name, "expected columns MARKER.x, MARKER.y, MARKER.z")
        if np.isnan(column).all():
            raise InputError(path, name, "expected readings, or no such column; all are missing")
        values[:, markers.index(marker), AXES.index(axis)] = column
    variables = {"marker_displacement": (("time", "marker", "axis"), values, {"units": "m"})}
    coordinates = {"time": time, "marker": markers, "axis": list(AXES)}
    wanted = f"{path.stem}-acc.csv".lower()
    for companion in sorted(item for item in path.parent.iterdir() if item.name.lower() == wanted)[:1]:
        time_acc, read = read_columns(file_below(path.parent, companion.name, path, "accelerometers"))
        coordinates["time_acc"] = time_acc
        for variable, dimension, sensors, unit in (
            ("accelerometer", "channel", [name for name in read if name not in transducers], "m s-2"),
            ("transducer_displacement", "transducer", [name for name in read if name in transducers], "m"),
        ):
            if sensors:
                values = np.column_stack([read[name] for name in sensors])
                variables[variable] = (("time_acc", dimension), values, {"units": unit})
                coordinates[dimension] = sensors
    return xr.Dataset(variables, coordinates)


def read_columns(path):
    """Times and columns of a CSV; empty cells are NaN."""
    table = read_table(path, TableLayout())
    if "time_s" not in table.names or len(table.names) < 2 or len(set(table.names)) < len(table.names):
        wrong = "expected a header with time_s, other columns and every name once, and rows below it"
        raise InputError(path, "time_s", wrong)
    return table.times("time_s"), {name: table.column(name) for name in table.names if name != "time_s"}
