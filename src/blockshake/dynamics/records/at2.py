"""PEER "AT2": four header lines, then accelerations in g, usually five a line."""

import re

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import SPECTRUM, Record, free_values, positive_number
from blockshake.errors import InputError
from blockshake.tables.units import known_unit, leading_unit, unit_size

_COUNT = re.compile(r"NPTS\s*=\s*([^\s,;]+)", re.IGNORECASE)
_STEP = re.compile(
    r"\bDT\s*=\s*([^\s,;]+?)(?=M?SEC\b|[\s,;]|$)[\s,;]*(?:([A-Z]+)\b(?!\s*[=:]))?", re.IGNORECASE
)
_TRAILING = re.compile(r"^\s*([^\s,]+)[\s,]+([^\s,]+)[\s,]+NPTS\s*,\s*DT", re.IGNORECASE)
_LENGTH = re.compile(r"\bDUR(?:ATION)?\s*[=:]\s*([^\s,;]+)", re.IGNORECASE)
_RATE = re.compile(r"\b(?:FS|RATE)\s*[=:]\s*([^\s,;]+)|([^\s,;]+)\s*SPS\b", re.IGNORECASE)
_PEAK = re.compile(r"\b(?:PGA|PEAK)\s*[=:]\s*([-+.\d]+(?:E[-+]?\d+)?)\s*([^\s,;]*)", re.IGNORECASE)
_UNIT = re.compile(r"ACCEL.*?\bUNITS?\b\s*(?:OF|IN|[:=])?\s*(.*)", re.IGNORECASE)
_HEADER_LINES = 4


def is_at2(text):
    """Whether a text looks like an AT2 file."""
    return any("NPTS" in line.upper() for line in text.lstrip().split("\n", _HEADER_LINES)[:_HEADER_LINES])


def read_at2(text, where):
    """Records, a list of one, from the text of an AT2 file; g is 9.80665 m/s2.

    Line 4 is read as ``NPTS= 4000, DT= .0050 SEC``, in any order, and as ``4000 0.0050 NPTS, DT``; line 3 as
    ``ACCELERATION TIME SERIES IN UNITS OF G``, with whatever stands before and behind the unit.

    Raises
    ------
    InputError
        Line 3 names no unit of acceleration, line 4 gives no NPTS and DT, a value is not a
        finite number, or their number differs from NPTS.
    """
    lines = text.split("\n")
    if len(lines) < _HEADER_LINES:
        raise InputError(where, "", f"expected four header lines of an AT2 file, found {len(lines)} lines")
    sizes = [
        index for index, line in enumerate(lines, 1) if index >= _HEADER_LINES and "NPTS" in line.upper()
    ]
    first = sizes[0] if sizes else _HEADER_LINES  # behind blank lines, if there are some
    event, kind, line = lines[first - 3 : first]
    stated = _UNIT.search(kind)
    if not stated or SPECTRUM.search(kind):
        raise InputError(
            where,
            f"line {first - 1}",
            f"expected 'ACCELERATION ... IN UNITS OF G', found '{kind.strip()}'",
        )
    unit = float(leading_unit("acceleration", stated.group(1), where, f"line {first - 1}"))
    for pattern, key in ((_COUNT, "NPTS"), (_STEP, "DT")):
        if len(twice := dict.fromkeys(match.group(1) for match in pattern.finditer(line))) > 1:
            raise InputError(where, key, f"expected this entry once, found {' and '.join(twice)}")
    count_text, step_text, step_unit = _sizes(line, where, f"line {first}")
    count = positive_number(count_text.removesuffix("."), where, "NPTS", int)
    step = positive_number(step_text, where, "DT") * float(unit_size("time", step_unit or "s", where, "DT"))
    values = unit * free_values(lines, first, count, where, "NPTS")
    metadata = {"event": event.strip()} if event.strip() else {}
    checks = HeaderChecks(where, values, step)
    if length := _LENGTH.search(line):
        checks.length("DURATION", length.group(1))
    if rate := _RATE.search(line):
        checks.step("FS", repr(1.0 / positive_number(rate.group(1) or rate.group(2), where, "FS")))
    if peak := _PEAK.search(f"{kind}, {line}"):
        of_peak = known_unit(peak.group(2))
        checks.peak("PGA", peak.group(1), float(of_peak[1]) if of_peak else unit)
    return [Record(values, step, "PEER NGA AT2", checks.made, metadata=metadata)]


def _sizes(line, where, key):
    """Texts of the number of values, of the time step, and of its unit or None."""
    count, step, trailing = _COUNT.search(line), _STEP.search(line), _TRAILING.search(line)
    if count and step:
        return count.group(1), *step.groups()
    if trailing:
        return *trailing.groups(), None
    raise InputError(where, key, f"expected NPTS and DT, found '{line.strip()}'")
