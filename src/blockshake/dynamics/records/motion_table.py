"""A ground motion from a table of a user: any columns, units and decimal sign."""

from pathlib import Path

import numpy as np

from blockshake.dynamics.baseline import correct_baseline
from blockshake.dynamics.motion import CHANNELS, check_finite, ground_motion
from blockshake.dynamics.records.times import check_times, gap_words
from blockshake.errors import Argument, InputError
from blockshake.tables.table_file import read_table
from blockshake.tables.units import kind_of_unit, unit_size
from blockshake.tables.values_in_order import values_in_order


def load_motion_table(source, layout, time, columns, unit, time_unit, baseline, step=None):
    """`GroundMotion` from columns of a text file or a workbook.

    Parameters
    ----------
    source : str or path
        A file; of a workbook with several sheets ``FILE#SHEET``.
    layout : TableLayout
    time : str
        Name of the column of times.
    columns : dict of str to str
        By channel (``x``, ``y``, ``z``) the name of a column, behind a minus where it is reversed; none, with ``step``,
        takes all values of the file, line by line, as x.
    unit : str
        Unit of the columns: an acceleration, a velocity or a displacement.
    time_unit : str
    baseline : str or float
        As of `correct_baseline`: a table is corrected with a corner frequency alone.
    step : float, optional
        Between rows, or values, that have no times [s].

    Raises
    ------
    InputError
        A missing column, a column twice, an unknown unit or channel, a cell that is no number, times that do not
        increase or have a gap; a correction of other than evenly spaced accelerations.
    """
    kind = kind_of_unit(unit, ("acceleration", "velocity", "displacement"), Argument("unit"), unit)
    size = unit_size(kind, unit, Argument("unit"), unit)
    for channel in columns:
        if channel not in CHANNELS[:3]:
            raise InputError(Argument("columns"), channel, f"expected {', '.join(CHANNELS[:3])}")
    names = [name.strip().removeprefix("-") for name in columns.values()]
    if len({*names, *([time.strip()] if step is None else [])}) < len(names) + (step is None):
        wrong = "expected every column once, and not that of the times"
        raise InputError(Argument("columns"), ", ".join(names), wrong)
    assumed = [f"{unit.strip()}, as given"]
    if columns:
        table = read_table(source, layout)
        where, read = table.source, {}
        for key, name in columns.items():
            sign = -1 if name.strip().startswith("-") else 1
            assumed += [f"{key} is reversed"] * (sign < 0)
            name = name.strip().removeprefix("-")
            read[key] = _finite(table, name, table.column(name, sign * size, kind)) + 0.0
    else:
        where = str(source)
        values, said = values_in_order(source, layout, step)
        read, assumed = {"x": values * float(size)}, [*assumed, said]
    if step is None:
        times = table.times(time, unit_size("time", time_unit, Argument("time_unit"), time_unit))
        at = _finite(table, time, times)
        check_times(at, list(read.values()), table.lines, where, time)
    else:
        at = step * np.arange(len(next(iter(read.values()))))
        assumed.append(f"a step of {step:g} s, as given")
    if len(at) < 2:
        raise InputError(where, "", f"expected at least two rows, found {len(at)}")
    attributes = {"source": Path(source).name, "format": "table", "synthetic": False}
    attributes |= {"checked": "times" if step is None else "nothing", "assumed": "; ".join(assumed)}
    if words := gap_words(at):
        attributes["gaps"] = words
    if at[0] != 0.0:
        attributes["first_time"] = float(at[0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked at below
        motion = ground_motion(Path(source).stem, at - at[0], read, kind, attributes)
    check_finite(motion, where)
    return correct_baseline(motion, baseline, where)


def _finite(table, name, values):
    """Values of a column without gaps."""
    if not np.isfinite(values).all():
        raise table.fault(table.lines[int(np.argmin(np.isfinite(values)))], name, "expected a finite number")
    return values
