"""A ground motion from a table of a user: any columns, units and decimal sign, with times or a time step."""

import re
from pathlib import Path

import numpy as np

from blockshake.dynamics.baseline import settle
from blockshake.dynamics.motion import CHANNELS, check_finite, ground_motion
from blockshake.dynamics.records.header_checks import ROUNDING
from blockshake.dynamics.records.times import check_times
from blockshake.errors import Argument, InputError
from blockshake.tables.numbers import plain_number
from blockshake.tables.series_file import read_series
from blockshake.tables.table_file import read_table
from blockshake.tables.units import kind_of_unit, known_unit, unit_of_name, unit_size

# in the text above values without times
_NUMBER = r"((?:\d+\.?\d*|\.\d+)(?:[ed][-+]?\d+)?)"
_STEP = re.compile(
    r"\b(?:dt|delta[ _-]?t|(?:time|sampl\w*)[ _-]?(?:step|interval|period))\b\s*(?:[\[(](\w+)[\])])?\s*[=:]?\s*"
    rf"{_NUMBER}\s*([a-z]*)",
    re.IGNORECASE,
)
_RATE = re.compile(
    rf"(?:\bsampl\w*[ _-]*(?:rate|freq\w*)|\babtast\w*|\bfs\b)[^\n\d]*?{_NUMBER}|^\s*{_NUMBER}\s*(?:hz|sps)\s*$",
    re.IGNORECASE | re.MULTILINE,
)
_COUNT = re.compile(
    r"\b(?:npts|(?:number|no\.?) of (?:points|values|samples|data))\s*[=:]?\s*(\d+)|"
    r"\b(\d+)\s+(?:points|samples)\b(?!\s*(?:/|per|a|each)\b)",
    re.IGNORECASE,
)
_COUNT_AND_STEP = re.compile(rf"(\d+)[\s,]+{_NUMBER}[\s,]+npts\s*,\s*dt", re.IGNORECASE)
_UNIT = re.compile(r"\bunits?\s*(?:of|in|[=:])\s*([^\s,;]+)", re.IGNORECASE)
_OF_VALUES = re.compile(r"acc|vel|disp|\bin\b|^\S+$", re.IGNORECASE)  # in a line that may end with their unit


def load_motion_table(source, layout, time, columns, unit, time_unit, baseline, time_step):
    """`GroundMotion` from columns of a text file or a workbook.

    Parameters
    ----------
    source : str or path
        A file; of a workbook with several sheets ``FILE#SHEET``.
    layout : TableLayout
    time : str
        Name of the column of times; nothing is read from it where there is a ``time_step``.
    columns : dict of str to str
        By channel (``x``, ``y``, ``z``) the name of a column. None at all, with a ``time_step``: the file's values,
        row by row, are x.
    unit : str
        Of the columns; tells acceleration, velocity and displacement apart.
    time_unit : str
    baseline : str or float
        As of `settle`: a table is corrected with a corner frequency alone.
    time_step : float or None
        Of values without times [s].

    Raises
    ------
    InputError
        A missing column, a column twice, an unknown unit or channel, a cell that is no number, times that do not
        increase or have a gap; a correction of other than evenly spaced accelerations.
    """
    kind = kind_of_unit(unit, ("acceleration", "velocity", "displacement"), Argument("unit"), unit)
    given = kind, unit_size(kind, unit, Argument("unit"), unit)
    for channel in columns:
        if channel not in CHANNELS[:3]:
            raise InputError(Argument("columns"), channel, f"expected {', '.join(CHANNELS[:3])}")
    names = [name.strip() for name in columns.values()]
    if len(set(names)) < len(names) or (time_step is None and time.strip() in names):
        raise InputError(
            Argument("columns"), ", ".join(names), "expected every column once, and not that of the times"
        )
    assumed = f"{unit.strip()}, as given"
    if columns:
        table = read_table(source, layout)
        where = table.source
        read = {channel: _finite(table, name, *reversed(given)) for channel, name in columns.items()}
        if time_step is not None:
            _check_untimed(table, names, time_step)
    else:
        where = str(source)
        read, width = _series(source, layout, time_step, given)
        if width > 1:
            assumed += f"; {width} values a line, row by row"
    if time_step is None:
        at = _finite(table, time, unit_size("time", time_unit, Argument("time_unit"), time_unit), "time")
        check_times(at, table.lines, where, time)
    else:
        at = time_step * np.arange(len(next(iter(read.values()))))
        assumed += f"; a time step of {time_step:g} s, as given"
    if len(at) < 2:
        raise InputError(where, "", f"expected at least two rows, found {len(at)}")
    attributes = {"source": Path(source).name, "format": "table", "synthetic": False}
    attributes |= {"checked": "nothing" if time_step else "times", "assumed": assumed}
    if at[0] != 0.0:
        attributes["first_time"] = float(at[0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked at below
        motion = ground_motion(Path(source).stem, at - at[0], read, kind, attributes)
    check_finite(motion, where)
    return settle(motion, baseline, where)


def _finite(table, name, size, kind):
    """A column without gaps."""
    values = table.column(name, size, kind)
    if not np.isfinite(values).all():
        line = table.lines[int(np.argmin(np.isfinite(values)))]
        raise InputError(table.source, f"line {line}, {name}", "expected a finite number")
    return values


def _check_untimed(table, columns, time_step):
    """Refuse another column that counts as times do, in other steps than the given one; numbers of rows may."""
    for name in table.names:
        try:
            time = None if name in columns else table.column(name)
        except InputError:  # words
            time = None
        if time is None or len(time) < 2 or not (np.diff(time) > 0.0).all():
            continue
        if not np.isclose((time[-1] - time[0]) / (len(time) - 1), [1.0, time_step], rtol=ROUNDING).any():
            wrong = f"expected a table without times; '{name}' counts as they do: --time and --time-unit"
            raise InputError(Argument("time_step"), f"{time_step:g}", wrong)


def _series(source, layout, time_step, given):
    """Values without times in SI as x, and their number a line; the text above may not contradict what was given."""
    values, header, width = read_series(source, layout)
    text = header.replace(layout.decimal, ".")
    steps = [_seconds(number, one or two) for one, number, two in _STEP.findall(text)]
    steps += [1.0 / (_seconds(one or two, "") or np.inf) for one, two in _RATE.findall(text)]
    counts = [float(one or two) for one, two in _COUNT.findall(text)]
    for count, step in _COUNT_AND_STEP.findall(text):
        counts, steps = [*counts, float(count)], [*steps, _seconds(step, "")]
    for stated, actual, name in (
        (steps, time_step, "--time-step"),
        (counts, len(values), "number of values"),
    ):
        for one in stated:
            if abs(one - actual) > ROUNDING * actual * (name == "--time-step"):
                raise InputError(source, name, f"expected {one:g}, as the file says, found {actual:g}")
    named = [(stated, known_unit(stated)) for stated in _UNIT.findall(header)]
    for line in header.split("\n"):
        own = given[0] if _OF_VALUES.search(line) else None
        named.append((line, unit_of_name(line.rstrip(" :.,;"), own)))
    for stated, unit in named:
        if unit and unit != given and unit[0] in ("acceleration", given[0]):
            raise InputError(source, "--unit", f"expected '{stated}', as the file says")
    return {"x": float(given[1]) * values}, width


def _seconds(number, unit):
    """A text's number in a unit of time, s where it is none [s]."""
    kind, size = known_unit(unit) or ("", 1)
    return float(plain_number(number)) * (float(size) if kind == "time" else 1.0)
