"""COSMOS strong-motion format 1.20, volume 2: text, integer and real headers, then fixed columns.

Facts of the format: COSMOS Strong Motion Data Format, version 1.20 (2001). Each block is
announced by a line that says how many values follow and in which Fortran format.
"""

import re

from blockshake.dynamics.records.record import Record, acceleration_unit, positive_number, values_of
from blockshake.errors import InputError

_BLOCK = re.compile(
    r"^\s*(\d{1,9})\s+(integer|real)-header values follow.*format\s*=\s*\((.*)\)", re.IGNORECASE
)
_SERIES = re.compile(
    r"^\s*(\d+)\s+(acceleration|velocity|displacement|\S+)\s+p(?:oin)?ts\b.*?units\s*=\s*([^,(]+)(?:\(\s*\d+\s*\))?\s*,"
    r"\s*format\s*=\s*\((.*)\)",
    re.IGNORECASE,
)
_FORTRAN = re.compile(r"^\s*(\d*)\s*[EFGDI]\s*(\d+)", re.IGNORECASE)
_SAMPLE_INTERVAL = 34  # entry of the real header, from 1: sampling interval of the series [ms]


def is_cosmos(text):
    """Whether a text looks like a COSMOS file."""
    return any(_BLOCK.match(line) for line in text.splitlines()[:60])


def read_cosmos(text, where):
    """Record from the text of a COSMOS volume 2 file.

    Velocity and displacement series in the file are passed over: integration is ours.

    Raises
    ------
    InputError
        Headers or data are missing or cut short, the unit is unknown, a value is not a finite
        number, or the file holds no or more than one acceleration series.
    """
    lines = text.splitlines()
    step, found = None, []
    index = 0
    while index < len(lines):
        block, series = _BLOCK.match(lines[index]), _SERIES.match(lines[index])
        if block:
            count = int(block.group(1))
            columns, width = _columns(block.group(3), where, index + 1)
            rows = -(-count // columns)
            if block.group(2).lower() == "real" and step is None:
                step = _time_step(lines[index + 1 : index + 1 + rows], width, where)
            index += rows
        elif series:
            count = positive_number(series.group(1), where, f"line {index + 1}", int)
            columns, width = _columns(series.group(4), where, index + 1)
            rows = -(-count // columns)
            if series.group(2).lower() == "acceleration":
                found.append((index, count, rows, width, series.group(3)))
            index += rows
        index += 1
    if len(found) != 1:
        raise InputError(
            where, "", f"expected one acceleration series, found {len(found)}: one channel a file"
        )
    if step is None:
        raise InputError(where, "", "expected a real header, which holds the sampling interval")
    index, count, rows, width, unit_text = found[0]
    unit = acceleration_unit(unit_text, where, f"line {index + 1}")
    end = min(index + 1 + rows, len(lines))
    data = (
        (number + 1, _split(lines[number], width))
        for number in range(index + 1, end)
        if not _ends(lines[number])
    )
    values = values_of(data, count, where, f"line {index + 1}")
    metadata = {"event": lines[1].strip()} if lines[1].strip() else {}
    return Record(unit * values, step, "COSMOS V2", metadata)


def _columns(fortran, where, line):
    """Columns and width of a Fortran format such as ``8F10.5`` or ``1E15.6``."""
    match = _FORTRAN.match(fortran)
    if not match:
        raise InputError(
            where, f"line {line}", f"expected a Fortran format such as (8F10.3), found '({fortran})'"
        )
    columns, width = match.group(1) or "1", match.group(2)
    return tuple(positive_number(number, where, f"line {line}, format", int) for number in (columns, width))


def _split(line, width):
    """Numbers of one line, cut at fixed columns: they may touch."""
    line = line.rstrip()
    return [line[start : start + width] for start in range(0, len(line), width)]


def _ends(line):
    return line.lower().startswith("end-of-data")


def _time_step(lines, width, where):
    entries = [entry for line in lines for entry in _split(line, width)]
    key = f"real header, entry {_SAMPLE_INTERVAL}"
    if len(entries) < _SAMPLE_INTERVAL:
        raise InputError(where, key, "expected the sampling interval in ms; the header is cut short")
    return 1e-3 * positive_number(entries[_SAMPLE_INTERVAL - 1], where, key)
