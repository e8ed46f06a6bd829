"""Columns of a table as a map of an import names them: times and readings in SI."""

import contextlib
from typing import NamedTuple

import numpy as np
import scipy

from blockshake.dynamics.records.times import check_increase, gaps_words
from blockshake.errors import InputError
from blockshake.measurement.campaigns.clocks import LACKING, missing_rows
from blockshake.measurement.campaigns.faulty_readings import stuck
from blockshake.measurement.checks.quiet_noise import NORMAL
from blockshake.tables.table_file import TableLayout, read_table
from blockshake.tables.units import unit_size

_SAME_TIME = 0.01  # of a step, within which two times are one
_FIRST = 0.5  # s at most of the rest, whose readings tell where a sensor starts, and its noise
_IN_A_ROW = 5  # readings, whose median no single outlier moves
# times the noise of a reading: within the first all are at rest, beyond the second one moves
_AT_REST, _MOVES = 3.0, 10.0


class TimedColumns(NamedTuple):
    """Columns of a table in SI."""

    time: np.ndarray  # float64 (n_times,) [s]
    values: np.ndarray  # float64 (n_times, n_columns); NaN in gaps
    remarks: list


@contextlib.contextmanager
def by_key(import_map, where, key=None):
    """Name the key of the map, ``key`` or what the fault names, of all faults but those of a line or a whole file."""
    try:
        yield
    except InputError as error:
        if error.where == str(where) or not error.key or error.key.startswith("line "):
            raise
        if error.key in TableLayout.model_fields:
            wrong = f"{error.where}: {error.expected}"
            raise InputError(where, f"layout.{error.key}", wrong) from None
        if key is None:
            mapped = [f"columns.{one}" for one in import_map.columns if f"{one}.".startswith(f"{error.key}.")]
            mapped += ["time"] * error.key.startswith("time")
            mapped += ["displacement_unit"] * error.key.endswith("_displacement")
            key = (*mapped, "columns")[0]
        elif not error.key.startswith("column "):
            raise
        raise InputError(where, key, str(error)) from None


def check_once(names, import_map, where):
    """Refuse a column of one table that is mapped twice."""
    taken = {import_map.time.column: "time"}
    for name in names:
        column = import_map.columns[name].column
        other = taken.setdefault(column, name)
        if other != name:
            wrong = f"expected a column of its own; '{column}' is {other}; of several of one name a number names one"
            raise InputError(where, f"columns.{name}", wrong)


def recorder_map(import_map):
    """The map as it holds for the files of accelerometers."""
    stated = {key: value for key, value in import_map.accelerometers if value is not None}
    return import_map.model_copy(update=stated)


@contextlib.contextmanager
def _keys_of_recorder(import_map, where, recorder):
    """Faults of the files of accelerometers name the keys that hold for these."""
    try:
        yield
    except InputError as error:
        key = error.key.partition(".")[0]
        if not recorder or error.where != str(where) or getattr(import_map.accelerometers, key, None) is None:
            raise
        raise InputError(where, f"accelerometers.{error.key}", error.expected) from None


def columns_of(source, names, import_map, kind, where, recorder=False):
    """`TimedColumns` of the readings ``names`` of a table of markers, or of a recorder."""
    with _keys_of_recorder(import_map, where, recorder):
        return _columns_of(source, names, recorder_map(import_map) if recorder else import_map, kind, where)


def _columns_of(source, names, import_map, kind, where):
    with by_key(import_map, where, "time"):
        table = read_table(source, import_map.layout)
    read, clocks = {}, {}
    for name in names:
        column = import_map.columns[name]
        unit, key = column.unit or getattr(import_map, f"{kind}_unit"), f"columns.{name}"
        if unit is None:
            raise InputError(where, f"{kind}_unit", f"missing key; {name} needs it")
        size = unit_size(kind, unit, where, f"{key}.unit" if column.unit else f"{kind}_unit")
        entry, key_of_time = import_map.time, "time"
        if column.time is not None:
            entry, key_of_time = entry.model_copy(update={"column": column.time}), f"{key}.time"
        with by_key(import_map, where, key):
            place = table.place(column.column)
        with by_key(import_map, where, key_of_time):
            at = None if entry.column is None else table.place(entry.column, place)
            if at not in clocks:
                clocks[at] = _clock(table, entry, at, import_map, where)
        with by_key(import_map, where, key):
            values = table.column(column.column, -size if column.reversed else size, kind)
        if np.isnan(values).all() and len(import_map.tests) == 1:
            wrong = f"expected readings in '{column.column}' of {table.source}; all are missing"
            raise InputError(where, key, wrong)
        late = np.flatnonzero(np.isfinite(values[len(clocks[at]) :]))
        if late.size:
            raise table.fault(table.lines[len(clocks[at]) + late[0]], entry.column, "expected a time")
        read[name] = (clocks[at], values[: len(clocks[at])] + 0.0)  # no minus zero
    clock, remarks = max(clocks.values(), key=len), []
    for name, (time, values) in read.items():
        if time is not clock:
            values, apart = at_times(clock, time, values)
            read[name] = (clock, values)
            remarks += [f"{name}: read between its own times, up to {apart:.2g} s off the others'"] * (
                apart > 0.0
            )
    return TimedColumns(clock, np.column_stack([values for _, values in read.values()]), remarks)


def at_times(clock, time, values):
    """Readings (n_times,) at the times of another clock, and how far these are off at most [s].

    Between two readings on a line; NaN where their clock has none within one and a half steps. Times within a
    hundredth of a step are the same.
    """
    step = np.median(np.diff(time))
    after = np.clip(np.searchsorted(time, clock), 1, len(time) - 1)
    nearest = np.where(clock - time[after - 1] < time[after] - clock, after - 1, after)
    off = np.abs(time[nearest] - clock)
    same = off <= _SAME_TIME * step
    inside = (clock >= time[0]) & (clock <= time[-1]) & (time[after] - time[after - 1] <= LACKING * step)
    share = (clock - time[after - 1]) / (time[after] - time[after - 1])
    between = values[after - 1] + share * (values[after] - values[after - 1])
    read = np.where(same, values[nearest], np.where(inside, between, np.nan))
    apart = off[inside & ~same]
    return read, float(apart.max()) if apart.size else 0.0


def _clock(table, entry, place, import_map, where):
    """Times that increase [s], of a column by its place, or of frames at a rate."""
    if place is None:
        return np.arange(len(table.rows)) / entry.rate
    name = table.names[place] if table.names.count(table.names[place]) == 1 else str(place + 1)
    if entry.rate is None:
        time = table.times(name, unit_size("time", entry.unit or "s", where, "time.unit"))
    else:
        time = table.column(name, kind=None)
        known = np.isfinite(time)
        if (time[known] % 1.0).any():
            row = int(np.argmax(known & (time % 1.0 != 0.0)))
            raise table.fault(
                table.lines[row], name, f"expected a frame's number, not {time[row]:g}; with times no rate"
            )
        time = time / entry.rate
    if np.isfinite(time).any():  # others may have more rows
        time = time[: int(np.flatnonzero(np.isfinite(time))[-1]) + 1]
    if np.isnan(time).any():
        raise table.fault(table.lines[int(np.argmax(np.isnan(time)))], name, "expected a time")
    check_increase(time, table.lines, table.source, name)
    missing = missing_rows(time) if len(time) > 1 else np.zeros(0)
    if missing.any() and not import_map.fill_gaps:
        row, steps = int(np.argmax(missing > 0)), np.diff(time)
        raise InputError(
            where, "fill_gaps",
            f"{table.source}: line {table.lines[row + 1]}, {name}: expected an even clock; {steps[row]:.4g} s after "
            f"{time[row]:.13g} s lie between two rows {np.median(steps):.4g} s apart elsewhere, "
            f"{gaps_words(missing)} in all: fill_gaps makes them gaps of the readings",
        )  # fmt: skip
    return time


def rest_of(time, column, import_map, where, name, noise):
    """Mean reading of the quiet start; zero of a column without readings, which the check of a test finds so.

    ``noise``: stated standard deviation of a reading [m]. A column that moves within the stated rest is refused.
    """
    if import_map.rest == 0.0 or np.isnan(column).all() or stuck(column):
        return 0.0
    rows = np.flatnonzero((time <= time[0] + import_map.rest) & np.isfinite(column))
    if not len(rows):
        raise InputError(
            where, "rest", f"{name}: expected a reading in the first {import_map.rest:g} s of rest"
        )
    begun = _motion_begins(time[rows], column[rows], noise)
    if begun is not None:
        raise InputError(
            where, "rest",
            f"{name}: expected rest in the first {import_map.rest:g} s, of which it rests for "
            f"{begun - time[0]:.3g} s: it moves from {begun:.4g} s on",
        )  # fmt: skip
    return column[rows].mean()


def _motion_begins(time, column, noise):
    """Time at which readings (n_times,) leave where they start, beyond their noise, for some in a row; None of rest."""
    first = column[time <= time[0] + _FIRST]
    steps = np.abs(np.diff(first))  # whose median neither a slow motion nor a knock enters
    own = np.median(steps) / NORMAL / np.sqrt(2.0) if len(steps) else 0.0
    smooth = scipy.ndimage.median_filter(column, _IN_A_ROW, mode="nearest")
    away, least = np.abs(smooth - np.median(first[:_IN_A_ROW])), max(own, noise)
    return float(time[np.argmax(away > _AT_REST * least)]) if away.max() > _MOVES * least else None
