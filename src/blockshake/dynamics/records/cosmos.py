"""COSMOS strong-motion format 1.20, volume 2: text, integer and real headers, then fixed columns.

Facts of the format: COSMOS Strong Motion Data Format, version 1.20 (2001), tables 5 to 8. Each block is
announced by a line that states how many values follow and in which Fortran format.
"""

import re

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import Record, cut_columns, fixed_values, positive_number
from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number
from blockshake.tables.units import known_unit, leading_unit

_BLOCK = re.compile(
    r"^\s*(\d{1,9})\s+(integer|real)-header values follow.*format\s*=\s*\((.*)\)", re.IGNORECASE
)
_SERIES = re.compile(
    r"^\s*(\d+)\s+(acceleration|velocity|displacement|\S+)\s+p(?:oin)?ts\b(?:.*?approx\s*([\d.]+)\s*sec)?.*?"
    r"units\s*=\s*(.+?)\s*,\s*format\s*=\s*\((.*)\)",
    re.IGNORECASE,
)
_PEAK = re.compile(r"(?<!uncor )\bmax\s*=\s*(\S+)\s+(\S+)\s+at\s+(\S+)\s*sec", re.IGNORECASE)
_CHANNEL = re.compile(r"\bchan\s+\S+?:\s*(.*?)\s*(?:\(|$)", re.IGNORECASE)
_FORTRAN = re.compile(r"^\s*(\d*)\s*[EFGDI]\s*(\d+)", re.IGNORECASE)
# entries of the real header, from 1: of this series, while those around 34 are of the raw record
_STEP, _LENGTH, _PEAK_VALUE, _PEAK_TIME = 62, 63, 64, 65  # ms, s, in the series' unit, s
_UNKNOWN = -999.0


def is_cosmos(text):
    """Whether a text looks like a COSMOS file."""
    return any(_BLOCK.match(line) for line in text.split("\n")[:60])


def read_cosmos(text, where):
    """Records, one a channel, from the text of a COSMOS volume 2 file.

    Velocity and displacement series in the file are passed over: integration is ours. The time step is entry 62 of the
    real header or, where that is unknown, the length of entry 63 over the number of values.

    Raises
    ------
    InputError
        Headers or data are missing or cut short, the unit is unknown, a value is not a finite number, the file holds
        no acceleration series; or the length of entry 63 or of the line of the series, the peak or its time contradict
        the values.
    """
    lines = text.split("\n")
    records, real, start, index = [], None, 0, 0
    while index < len(lines):
        block, series = _BLOCK.match(lines[index]), _SERIES.match(lines[index])
        if block:
            count = int(block.group(1))
            columns, width = _columns(block.group(3), where, index + 1)
            rows = -(-count // columns)
            if block.group(2).lower() == "real":
                block = lines[index + 1 : index + 1 + rows]
                real = [entry for line in block for entry in cut_columns(line, width)]
            index += rows
        elif series:
            count = positive_number(series.group(1), where, f"line {index + 1}", int)
            layout = _columns(series.group(5), where, index + 1)
            if series.group(2).lower() == "acceleration":
                if real is None:
                    raise InputError(
                        where,
                        f"line {index + 1}",
                        "expected a real header before it, which holds the time step",
                    )
                records.append(_record(lines, index, start, real, series, layout, where))
                real, start = None, index + 1
            index += -(-count // layout[0])
        index += 1
    if not records:
        raise InputError(where, "", "expected an acceleration series, found none")
    return records


def _record(lines, index, start, real, series, layout, where):
    """Record of the series that begins below a line, with its headers from line ``start`` on."""
    line = f"line {index + 1}"
    count = int(series.group(1))
    unit = float(leading_unit("acceleration", series.group(4), where, line))
    values = unit * fixed_values(lines, index + 1, count, layout, where, line)
    entries = [_entry(real, number) for number in (_STEP, _LENGTH, _PEAK_VALUE, _PEAK_TIME)]
    keys = [f"real header, entry {number}" for number in (_STEP, _LENGTH, _PEAK_VALUE, _PEAK_TIME)]
    assumed = ""
    if entries[0] is not None:
        step = 1e-3 * positive_number(entries[0], where, keys[0])
    elif entries[1] is not None:
        step = positive_number(entries[1], where, keys[1]) / count
        assumed = f"a time step of {step:g} s, the length over the number of values"
    else:
        wrong = f"expected the time step in ms, or the length in s in entry {_LENGTH}"
        raise InputError(where, keys[0], wrong)
    checks = HeaderChecks(where, values, step)
    checks.length(keys[1], entries[1])
    checks.length(line, series.group(3), slack=1.0)  # whole seconds, rounded or cut
    checks.peak(keys[2], entries[2], unit)
    checks.peak_time(keys[3], entries[3])
    for number, text in enumerate(lines[start:index], start + 1):
        stated = _PEAK.search(text)
        kind, size = known_unit(stated.group(2)) or (None, 0) if stated else (None, 0)
        if kind == "acceleration":
            checks.peak(f"line {number}", stated.group(1), float(size))
            checks.peak_time(f"line {number}", stated.group(3))
    channel = next((match.group(1) for match in map(_CHANNEL.search, lines[start:index]) if match), "")
    metadata = {"event": lines[1].strip()} if lines[1].strip() else {}
    return Record(values, step, "COSMOS V2", checks.made, assumed, channel, metadata)


def _entry(real, number):
    """Text of an entry of the real header; None where it is unknown or the header ends before it."""
    text = real[number - 1].strip() if number <= len(real) else ""
    number = plain_number(text)
    return None if number is not None and float(number) == _UNKNOWN else text or None


def _columns(fortran, where, line):
    """Columns and width of a Fortran format such as ``8F10.5`` or ``1E15.6``."""
    match = _FORTRAN.match(fortran)
    if not match:
        wrong = f"expected a Fortran format such as (8F10.3), found '({fortran})'"
        raise InputError(where, f"line {line}", wrong)
    columns, width = match.group(1) or "1", match.group(2)
    return tuple(positive_number(number, where, f"line {line}, format", int) for number in (columns, width))
