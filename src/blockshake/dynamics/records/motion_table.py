"""A ground motion from a table of a user: any columns, units and decimal sign."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.baseline import correct_baseline
from blockshake.dynamics.motion import CHANNELS, check_finite, ground_motion
from blockshake.dynamics.records.joined_rows import joined_rows
from blockshake.dynamics.records.text_header import check_text_header
from blockshake.dynamics.records.times import check_times, gap_words
from blockshake.errors import Argument, InputError
from blockshake.files import read_foreign_text
from blockshake.tables.table_file import WORKBOOK, TableLayout, read_table
from blockshake.tables.units import kind_of_unit, unit_of_name, unit_size
from blockshake.tables.values_in_order import values_in_order

_ALL = "values"  # in place of a column: all values of a file in order


class _Form(NamedTuple):
    """How the user says that a table is written; ``step`` [s] is None where there are times."""

    layout: TableLayout
    time: str
    unit: str
    time_unit: str
    step: float | None


def load_motion_table(source, layout, time, columns, unit, time_unit, baseline, step=None, components=None):
    """`GroundMotion` from columns of a text file or a workbook.

    Parameters
    ----------
    source : str or path
        A file; of a workbook with several sheets ``FILE#SHEET``.
    layout : TableLayout
    time : str
        Name of the column of times.
    columns : dict of str to str
        By channel (``x``, ``y``, ``z``) the name of a column, behind a minus where it is reversed. With ``step``,
        ``values`` takes all values of the file, line by line; none takes them as x.
    unit : str
        Unit of the columns: an acceleration, a velocity or a displacement.
    time_unit : str
    baseline : str or float
        As of `correct_baseline`: a table is corrected with a corner frequency alone.
    step : float, optional
        Between rows, or values, that have no times [s].
    components : dict of str to path, optional
        By channel files in the same form, of which the one column is taken; behind a minus where it is reversed.

    Raises
    ------
    InputError
        A missing column, a column twice, an unknown unit or channel, a cell that is no number, times that do not
        increase or have a gap, a header that contradicts unit, step or number of values; components of other times; a
        correction of other than evenly spaced accelerations.
    """
    kind = kind_of_unit(unit, ("acceleration", "velocity", "displacement"), Argument("unit"), unit)
    columns = columns or {"x": _ALL}
    for name, given in (("columns", columns), ("components", components or {})):
        for channel in given:
            if channel not in CHANNELS[:3]:
                raise InputError(Argument(name), channel, f"expected {', '.join(CHANNELS[:3])}")
    names = [name.strip().removeprefix("-") for name in columns.values()]
    if len({*names, *([time.strip()] if step is None else [])}) < len(names) + (step is None):
        wrong = "expected every column once, and not that of the times"
        raise InputError(Argument("columns"), ", ".join(names), wrong)
    form = _Form(layout, time, unit, time_unit, step)
    where, at, read, said = _read(source, form, columns)
    assumed = [f"{unit.strip()}, as given", *said]
    if components:
        if len(columns) > 1:
            raise InputError(
                Argument("components"), "", f"expected one column with them, not {', '.join(columns)}"
            )
        parts = {axis: (where, at, values) for axis, values in read.items()}
        for axis, other in components.items():
            if axis in parts:
                raise InputError(Argument("components"), axis, f"expected no second one; {where} is {axis}")
            sign = "-" if str(other).startswith("-") else ""
            try:
                part, times, values, more = _read(str(other).removeprefix("-"), form, {axis: sign + names[0]})
            except InputError as error:
                wrong = f"{error.expected}; files of other forms: convert each to a CSV, and join these by --component"
                raise InputError(error.where, error.key, wrong) from None
            parts[axis] = part, times, values[axis]
            assumed += [words for words in more if words not in assumed]
        at, read, rests = joined_rows(parts, kind)
        assumed += rests
    attributes = {"source": Path(source).name, "format": "table", "synthetic": False}
    attributes |= {"checked": "times" if step is None else "nothing", "assumed": "; ".join(assumed)}
    if components:
        attributes["components"] = ", ".join(
            f"{axis}: {Path(other).name}" for axis, other in components.items()
        )
    if words := gap_words(at):
        attributes["gaps"] = words
    if at[0] != 0.0:
        attributes["first_time"] = float(at[0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked at below
        motion = ground_motion(Path(source).stem, at - at[0], read, kind, attributes)
    check_finite(motion, where)
    return correct_baseline(motion, baseline, where)


def _read(source, form, columns):
    """Name, times [s], values in SI by axis and assumptions of one file."""
    layout, step = form.layout, form.step
    kind = kind_of_unit(form.unit, ("acceleration", "velocity", "displacement"), Argument("unit"), form.unit)
    size = unit_size(kind, form.unit, Argument("unit"), form.unit)
    signs = {axis: -1 if name.strip().startswith("-") else 1 for axis, name in columns.items()}
    names = {axis: name.strip().removeprefix("-") for axis, name in columns.items()}
    assumed, unit, at = (
        [f"{axis} is reversed" for axis, sign in signs.items() if sign < 0],
        (kind, size),
        None,
    )
    if step is not None and list(names.values()) == [_ALL]:
        where, (axis,) = str(source), names
        values, said, above = values_in_order(source, layout, step)
        read = {axis: values * float(signs[axis] * size) + 0.0}
        assumed.append(said)
    else:
        table = _table(source, layout, step)
        where = table.source
        read = {
            axis: _finite(table, name, table.column(name, signs[axis] * size, kind)) + 0.0
            for axis, name in names.items()
        }
        if any(unit_of_name(table.names[table.place(name)], kind) for name in names.values()):
            unit = None
        above = {}
        if Path(where).suffix.lower() not in WORKBOOK and Path(where).is_file():
            above = dict(enumerate(read_foreign_text(where).splitlines()[: layout.header[0] - 1], start=1))
        if step is None:
            time, time_unit = form.time, form.time_unit
            times = table.times(time, unit_size("time", time_unit, Argument("time_unit"), time_unit))
            at = _finite(table, time, times)
            check_times(at, list(read.values()), table.lines, where, time)
    count = len(next(iter(read.values())))
    check_text_header(above, where, unit, step, count)
    if count < 2:
        raise InputError(where, "", f"expected at least two rows, found {count}")
    if at is None:
        at = step * np.arange(count)
        assumed.append(f"a step of {step:g} s, as given")
    return where, at, read, assumed


def _table(source, layout, step):
    try:
        return read_table(source, layout)
    except InputError as error:
        if step is None or error.key != "header":
            raise
        wrong = f"{error.expected}; --column x={_ALL} takes all numbers in order, as y or z too"
        raise InputError(error.where, error.key, wrong) from None


def _finite(table, name, values):
    """Values of a column without gaps."""
    if not np.isfinite(values).all():
        raise table.fault(table.lines[int(np.argmin(np.isfinite(values)))], name, "expected a finite number")
    return values
