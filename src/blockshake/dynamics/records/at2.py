"""PEER NGA "AT2": four header lines, then accelerations in g, usually five a line."""

import re

from blockshake.dynamics.records.record import Record, acceleration_unit, positive_number, values_of
from blockshake.errors import InputError

_NAMED = re.compile(r"NPTS\s*=\s*([^\s,]+)\s*,?\s*DT\s*=\s*([^\s,]+)", re.IGNORECASE)
_TRAILING = re.compile(r"^\s*(\S+)\s+(\S+)\s+NPTS\s*,\s*DT", re.IGNORECASE)
_HEADER_LINES = 4


def is_at2(text):
    """Whether a text looks like an AT2 file."""
    return any("NPTS" in line.upper() for line in text.splitlines()[:_HEADER_LINES])


def read_at2(text, where):
    """Record from the text of an AT2 file; g is 9.80665 m/s2.

    Both writings of line 4 are read: ``NPTS= 4000, DT= .0050 SEC`` and ``4000 0.0050 NPTS, DT``.

    Raises
    ------
    InputError
        Line 3 names no unit of acceleration, line 4 gives no NPTS and DT, a value is not a
        finite number, or their number differs from NPTS.
    """
    lines = text.splitlines()
    if len(lines) < _HEADER_LINES:
        raise InputError(where, "", f"expected four header lines of an AT2 file, found {len(lines)} lines")
    stated = re.search(r"ACCELERATION.*UNITS? OF\s+(\S+)", lines[2], re.IGNORECASE)
    if not stated:
        raise InputError(
            where, "line 3", f"expected 'ACCELERATION ... IN UNITS OF G', found '{lines[2].strip()}'"
        )
    unit = acceleration_unit(stated.group(1), where, "line 3")
    sizes = _NAMED.search(lines[3]) or _TRAILING.search(lines[3])
    if not sizes:
        raise InputError(where, "line 4", f"expected NPTS and DT, found '{lines[3].strip()}'")
    count = positive_number(sizes.group(1), where, "NPTS", int)
    step = positive_number(sizes.group(2), where, "DT")
    data = ((number, line.split()) for number, line in enumerate(lines[_HEADER_LINES:], _HEADER_LINES + 1))
    metadata = {"event": lines[1].strip()} if lines[1].strip() else {}
    return Record(unit * values_of(data, count, where, "NPTS"), step, "PEER NGA AT2", metadata)
