"""Columns of a table as a map of an import names them: times and readings in SI."""

import contextlib

import numpy as np

from blockshake.dynamics.records.times import check_increase
from blockshake.errors import InputError
from blockshake.measurement.campaigns.clocks import missing_rows
from blockshake.measurement.campaigns.faulty_readings import stuck
from blockshake.tables.table_file import TableLayout, read_table
from blockshake.tables.units import unit_size


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
            raise InputError(where, f"columns.{name}", f"expected a column of its own; '{column}' is {other}")


def columns_of(source, names, import_map, kind, where):
    """Times (n_times,) and readings (n_times, n_names) of a table, in SI."""
    with by_key(import_map, where, "time"):
        table = read_table(source, import_map.layout)
        time = _clock(table, import_map, where)
    columns = []
    for name in names:
        column = import_map.columns[name]
        unit, key = column.unit or getattr(import_map, f"{kind}_unit"), f"columns.{name}"
        if unit is None:
            raise InputError(where, f"{kind}_unit", f"missing key; {name} needs it")
        size = unit_size(kind, unit, where, f"{key}.unit" if column.unit else f"{kind}_unit")
        with by_key(import_map, where, key):
            read = table.column(column.column, -size if column.reversed else size, kind)
        if np.isnan(read).all() and len(import_map.tests) == 1:
            wrong = f"expected readings in '{column.column}' of {table.source}; all are missing"
            raise InputError(where, key, wrong)
        columns.append(read + 0.0)  # no minus zero
    return time, np.column_stack(columns)


def _clock(table, import_map, where):
    """Times that increase [s]."""
    name = import_map.time.column
    time = table.times(name, unit_size("time", import_map.time.unit or "s", where, "time.unit"))
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
            f"{np.count_nonzero(missing)} such gaps in all: fill_gaps makes them gaps of the readings",
        )  # fmt: skip
    return time


def rest_of(time, column, import_map, where, name):
    """Mean reading of the quiet start; zero of a column without readings, which the check of a test finds so."""
    if import_map.rest == 0.0 or np.isnan(column).all() or stuck(column):
        return 0.0
    resting = column[(time <= time[0] + import_map.rest) & np.isfinite(column)]
    if not len(resting):
        raise InputError(
            where, "rest", f"{name}: expected a reading in the first {import_map.rest:g} s of rest"
        )
    return resting.mean()
