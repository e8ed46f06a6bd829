"""The project's own motion file: a CSV with ``time_s`` and columns of one kind, in SI."""

import contextlib
import csv
import io
from pathlib import Path

import numpy as np

from blockshake.dynamics.motion import CHANNELS
from blockshake.dynamics.records.record import finite_number
from blockshake.dynamics.records.times import check_times
from blockshake.errors import InputError
from blockshake.files import content_digest, load_json, write_json, write_text
from blockshake.geometry.schema import AXES
from blockshake.tables.numbers import missing_code

METADATA = "-metadata.json"
_OF_ITS_TIMES = ("first_time", "record_start")  # which a CSV counts from its own first row
KINDS = ("acceleration", "velocity", "displacement")


def read_motion_csv(text, where):
    """Time, columns and kind of a motion file.

    Parameters
    ----------
    text : str
        Content of the file: a header row, then numbers.
    where : str
        File that a message names.

    Returns
    -------
    time : float64 array, shape (n_rows,)
        Increasing, as in the file [s].
    columns : dict of str to float64 array, shape (n_rows,)
        By channel (``x``, ``y``, ``z``, ``pitch_y``).
    kind : str
        ``acceleration``, ``velocity`` or ``displacement``; ``displacement`` for a file of ``pitch_y`` alone.

    Raises
    ------
    InputError
        Unknown, repeated or missing column, mixed kinds, fewer than two rows, a cell that is not
        a finite number or stands for a missing one, a row of another length, time that does not increase or has a gap.
    """
    rows = [(number, row) for number, row in _rows(text) if any(cell.strip() for cell in row)]
    header = [cell.strip() for cell in rows[0][1]] if rows else []
    kind = _check_header(header, where)
    values, lines = np.empty((len(rows) - 1, len(header))), [number for number, _ in rows[1:]]
    if len(values) < 2:
        raise InputError(where, "", f"expected at least two rows of numbers, found {len(values)}")
    for index, (number, row) in enumerate(rows[1:]):
        if len(row) != len(header):
            raise InputError(where, f"line {number}", f"expected {len(header)} cells, found {len(row)}")
        values[index] = [
            finite_number(cell, where, f"line {number}, {name}")
            for name, cell in zip(header, row, strict=True)
        ]
    columns = {name: values[:, index] for index, name in enumerate(header)}
    return *_checked_rows(columns, lines, where, "line"), kind


def motion_of_arrays(arrays, where):
    """Time, columns and kind, as of `read_motion_csv`, of arrays (n_rows,) by the names of a motion file's columns.

    A table of pandas will do. Errors are those of `read_motion_csv`, with the number of a row from 0 for a line.
    """
    if not hasattr(arrays, "keys"):
        raise InputError(where, "", "expected a name, a path, or arrays by the names of columns")
    names = list(arrays.keys())  # of a table too, which is no mapping
    kind = _check_header(names, where)
    try:
        values = np.array([np.asarray(arrays[name], dtype=float) for name in names])
    except (TypeError, ValueError):  # texts, or lengths that differ
        values = np.empty(0)
    if values.ndim != 2 or values.shape[1] < 2:
        raise InputError(where, "", "expected arrays of at least two numbers, all of one length")
    for name, row in ((names[column], row) for column, row in np.argwhere(~np.isfinite(values))):
        raise InputError(where, f"row {row}, {name}", "expected a finite number")
    columns = dict(zip(names, values, strict=True))
    return *_checked_rows(columns, range(values.shape[1]), where, "row"), kind


def _checked_rows(columns, lines, where, row):
    """Times and columns by channel of rows of finite numbers, on these lines of a file."""
    time = columns.pop("time_s")
    for name, column in columns.items():
        coded = missing_code(column)
        if coded is not None:
            expected = f"expected a value; {column[coded]:g} looks like a code for none"
            raise InputError(where, f"{row} {lines[coded]}, {name}", expected)
    check_times(time, list(columns.values()), lines, where, "time_s", row)
    return time, {name if name == "pitch_y" else name[-1]: column for name, column in columns.items()}


def _rows(text):
    reader = csv.reader(io.StringIO(text.removeprefix("\ufeff")))
    for row in reader:
        yield reader.line_num, row


def _check_header(header, where):
    allowed = ["time_s", *(f"{kind}_{axis}" for kind in KINDS for axis in AXES), "pitch_y"]
    if "time_s" not in header:
        raise InputError(
            where,
            "time_s",
            "expected this column in the header row; `blockshake convert-motion` reads other tables",
        )
    for name in header:
        if name not in allowed:
            raise InputError(where, f"column '{name}'", f"expected one of {', '.join(allowed)}")
        if header.count(name) > 1:
            raise InputError(where, f"column '{name}'", "expected once, found more than once")
    kinds = [kind for kind in KINDS if any(name.startswith(f"{kind}_") for name in header)]
    if len(kinds) > 1:
        raise InputError(where, "", f"expected columns of one kind, found {' and '.join(kinds)}")
    if header == ["time_s"]:
        raise InputError(where, "", "expected at least one column of motion with time_s")
    return kinds[0] if kinds else "displacement"


def write_motion_csv(motion, path):
    """Write a motion as the project's CSV, in the kind it came from, with all its digits; its attributes with it.

    Channels that never move are left out (``x`` stays when all rest). Read again, the file gives
    the same displacement from its first row: a constant offset of a motion integrated from
    acceleration or velocity does not exist, and that of a displacement is kept.

    Parameters
    ----------
    motion : GroundMotion
    path : str or path
        Replaced atomically. ``PATH-metadata.json``, named as in CSV on the Web (W3C), holds the attributes, and a
        digest of the CSV: a CSV that was altered since has none.
    """
    breaks, coefficients = motion.table
    order = {"displacement": 0, "velocity": 1, "acceleration": 2}[motion.kind]
    moving = [index for index in range(4) if coefficients[:, index].any()] or [0]
    columns = {"time_s": breaks}
    for index in moving:
        if CHANNELS[index] == "pitch_y":
            columns["pitch_y"] = _at_rows(breaks, coefficients[:, index], 0)
        else:
            columns[f"{motion.kind}_{CHANNELS[index]}"] = _at_rows(breaks, coefficients[:, index], order)
    lines = [",".join(columns)]
    lines += [",".join(repr(float(cell)) for cell in row) for row in zip(*columns.values(), strict=True)]
    text = "\n".join(lines) + "\n"
    write_text(path, text)
    kept = {name: value for name, value in motion.attributes.items() if name not in _OF_ITS_TIMES}
    write_json(f"{path}{METADATA}", {"csv": content_digest(text.encode()), "attributes": kept})


def kept_attributes(path, text):
    """Attributes that `write_motion_csv` left next to a file of this text; none where the text is another."""
    metadata = Path(f"{path}{METADATA}")
    with contextlib.suppress(InputError, AttributeError, KeyError):
        kept = load_json(metadata) if metadata.is_file() else {}
        if kept.get("csv") == content_digest(text.encode()):
            attributes = kept["attributes"].items()
            return {name: value for name, value in attributes if isinstance(value, (str, int, float))}
    return {}


def _at_rows(breaks, c, order):
    """Values of a derivative of one channel at its rows, shape (n_rows,), to the last bit of the source."""
    last = breaks[-1] - breaks[-2]
    if order == 0:
        return np.append(c[:, 0], c[-1, 0] + last * (c[-1, 1] + last * (c[-1, 2] + last * c[-1, 3])))
    if order == 1:
        return np.append(c[:, 1], c[-1, 1] + last * (2.0 * c[-1, 2] + last * 3.0 * c[-1, 3]))
    return np.append(2.0 * c[:, 2], 2.0 * c[-1, 2] + 6.0 * last * c[-1, 3])
