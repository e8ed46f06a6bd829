"""Readings of one test from the tables of a user, in SI and as a campaign has them."""

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.campaigns.command_clock import missing_rows
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.tables.table_file import read_table
from blockshake.tables.units import unit_size


def read_readings(test, asked, structure, where):
    """Readings of one test.

    Parameters
    ----------
    test : ImportedTest
    asked : ImportMap
    structure : Structure
        Whose accelerometer channels and displacement transducers are told from markers.
    where : str
        Map that an error names.

    Returns
    -------
    xarray.Dataset
        As in a campaign's test file, not yet checked against the structure; NaN along directions without a column.

    Raises
    ------
    InputError
        A column that is missing or holds text, an unknown unit, times that go back, a clock with gaps.
    """
    channels = [name for name in asked.columns if name in accelerometer_channels(structure)]
    transducers = [name for name in asked.columns if name in transducer_names(structure)]
    markers = [name for name in asked.columns if name not in (*channels, *transducers)]
    if not markers:
        raise InputError(where, "columns", "expected a column of a marker, MARKER.x")
    source = test.accelerometers or test.file
    for names in (markers, [*channels, *transducers]) if source != test.file else (asked.columns,):
        check_once(names, asked, where)
    time, readings = columns_of(test.file, markers, asked, "displacement", where)
    names = list(dict.fromkeys(name.rpartition(".")[0] for name in markers))
    values = np.full((len(time), len(names), len(AXES)), np.nan)
    for key, column in zip(markers, readings.T, strict=True):
        name, _, axis = key.rpartition(".")
        if axis not in AXES or not name:
            raise InputError(
                where,
                f"columns.{key}",
                "expected MARKER.x, MARKER.y, MARKER.z, an accelerometer channel or a displacement transducer",
            )
        values[:, names.index(name), AXES.index(axis)] = column - _rest(
            time, column, asked.rest, test.file, key
        )
    variables = {"marker_displacement": (("time", "marker", "axis"), values, {"units": "m"})}
    coordinates = {"time": ("time", time, {"units": "s"}), "marker": names, "axis": list(AXES)}
    if channels:
        time_acc, read = columns_of(source, channels, asked, "acceleration", where)
        variables["accelerometer"] = (("time_acc", "channel"), read, {"units": "m s-2"})
        coordinates |= {"time_acc": ("time_acc", time_acc, {"units": "s"}), "channel": channels}
    if transducers:
        time_acc, read = columns_of(source, transducers, asked, "displacement", where)
        for column, key in zip(read.T, transducers, strict=True):
            column -= _rest(time_acc, column, asked.rest, source, key)
        variables["transducer_displacement"] = (("time_acc", "transducer"), read, {"units": "m"})
        coordinates |= {"time_acc": ("time_acc", time_acc, {"units": "s"}), "transducer": transducers}
    return xr.Dataset(variables, coordinates)


def check_once(names, asked, where):
    """Refuse a column of one table that is mapped twice."""
    taken = {asked.time.column: "time"}
    for name in names:
        other = taken.setdefault(asked.columns[name].column, name)
        if other != name:
            raise InputError(
                where,
                f"columns.{name}",
                f"expected a column of its own; '{asked.columns[name].column}' is {other}",
            )


def columns_of(source, names, asked, kind, where):
    """Times (n_times,) and readings (n_times, n_names) of a table, in SI."""
    table = read_table(source, asked.layout)
    time = _clock(table, asked, where)
    columns = []
    for name in names:
        column = asked.columns[name]
        unit, key = column.unit or getattr(asked, f"{kind}_unit"), f"columns.{name}"
        if unit is None:
            raise InputError(where, f"{kind}_unit", f"missing key; {name} needs it")
        size = unit_size(kind, unit, where, f"{key}.unit" if column.unit else f"{kind}_unit")
        read = table.column(column.column, -size if column.reversed else size, kind)
        if np.isnan(read).all():
            raise InputError(table.source, f"column '{column.column}'", "expected readings; all are missing")
        columns.append(read + 0.0)  # no minus zero
    return time, np.column_stack(columns)


def _clock(table, asked, where):
    """Times that increase [s]."""
    name = asked.time.column
    time = table.column(name, unit_size("time", asked.time.unit or "s", where, "time.unit"), "time")
    if np.isnan(time).any():
        line = table.lines[int(np.argmax(np.isnan(time)))]
        raise InputError(table.source, f"line {line}, {name}", "expected a time")
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        before, after = time[back[0] : back[0] + 2]
        raise InputError(
            table.source, f"line {table.lines[back[0] + 1]}, {name}",
            f"expected times that increase; {after:g} s follows {before:g} s",
        )  # fmt: skip
    missing = missing_rows(time) if len(time) > 1 else np.zeros(0)
    if missing.any() and not asked.fill_gaps:
        row, steps = int(np.argmax(missing > 0)), np.diff(time)
        raise InputError(
            table.source, f"line {table.lines[row + 1]}, {name}",
            f"expected an even clock; {steps[row]:.4g} s after {time[row]:g} s lie between two rows "
            f"{np.median(steps):.4g} s apart elsewhere, {np.count_nonzero(missing)} such gaps in all: fill_gaps makes "
            "them gaps of the readings",
        )  # fmt: skip
    return time


def _rest(time, column, length, source, key):
    """Mean reading of the quiet start."""
    if length == 0.0:
        return 0.0
    own = column[(time <= time[0] + length) & np.isfinite(column)]
    if not len(own):
        raise InputError(source, key, f"expected a reading in the first {length:g} s of rest")
    return own.mean()
