"""CSMIP (and older CDMG) "V2": 25 lines of text, whole and real numbers, then fixed columns; one to many channels."""

import re

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import Record, cut_columns, fixed_values, positive_number
from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number
from blockshake.tables.units import leading_unit, unit_size

_SERIES = re.compile(
    r"^\s*(\S+)\s+points of (accel)\S* data equally spaced at\s+(\S+)\s+sec(.*)$", re.IGNORECASE
)
_UNIT = re.compile(r"\b(?:in|units?\s*:?)\s+(?:units\s+of\s+)?([^()]+)", re.IGNORECASE)
_FORTRAN = re.compile(r"\((\d{1,4})[EFGD](\d{1,4})(?:\.\d+)?\)", re.IGNORECASE)
_USUAL_FORMAT = (8, 10)  # of files that name none
_COUNT = re.compile(r"^\s*(\d{1,9})\s+points of instrument", re.IGNORECASE)
_INTERVAL = re.compile(r"equally-spaced intervals of\s+(\S+)\s+sec", re.IGNORECASE)
_PEAK = re.compile(r"peak\s+acceleration\s*=\s*(\S+)\s+(\S+)\s+at\s+(\S+)\s*sec", re.IGNORECASE)
_CHANNEL = re.compile(r"\bchan\s+\S+?:\s*(.*?)\s*(?:\bfrom\b.*)?$", re.IGNORECASE)
_REALS, _REAL_COLUMNS, _REAL_WIDTH = 100, 8, 10
# entries of the real header, from 1 [s, s, s, cm/s2]
_LENGTH, _STEP, _TIME_OF_PEAK, _PEAK_VALUE = 60, 61, 65, 66


def is_csmip(text):
    """Whether a text looks like a CSMIP V2 file."""
    return any(map(_SERIES.match, text.split("\n")[:120]))


def read_csmip(text, where):
    """Records, one a channel, from the text of a CSMIP or CDMG volume 2 file.

    Velocity and displacement series in the file are passed over: integration is ours.

    Raises
    ------
    InputError
        Data are missing or cut short, the unit is unknown, a value is not a finite number; or the number of values, the
        time step, the length, the peak or its time, in the text or in the real header, contradict the values.
    """
    lines = text.split("\n")
    records, start = [], 0
    for index, line in enumerate(lines):
        series = _SERIES.match(line)
        if series:
            records.append(_record(lines, index, start, series, where))
            start = index + 1
    if not records:
        wrong = "expected a line 'N points of accel data equally spaced at DT sec', found none"
        raise InputError(where, "", wrong)
    return records


def _record(lines, index, start, series, where):
    """Record of the series that begins below a line, with its header from line ``start`` on."""
    key = f"line {index + 1}"
    count = positive_number(series.group(1), where, key, int)
    step = positive_number(series.group(3), where, key)
    stated = _UNIT.search(series.group(4))
    unit = float(leading_unit("acceleration", stated.group(1) if stated else "", where, key))
    fortran = _FORTRAN.search(series.group(4))
    layout = tuple(map(int, fortran.groups())) if fortran else _USUAL_FORMAT
    if 0 in layout:
        raise InputError(where, key, f"expected columns and their width, found {fortran.group()}")
    values = unit * fixed_values(lines, index + 1, count, layout, where, key)
    checks = HeaderChecks(where, values, step)
    channel = ""
    for number, text in enumerate(lines[start:index], start + 1):
        key = f"line {number}"
        if (match := _COUNT.search(text)) and int(match.group(1)) != count:
            wrong = f"expected {count} points, as the values have, found {match.group(1)}"
            raise InputError(where, key, wrong)
        if match := _INTERVAL.search(text):
            checks.step(key, match.group(1))
        if match := _PEAK.search(text):
            checks.peak(key, match.group(1), float(unit_size("acceleration", match.group(2), where, key)))
            checks.peak_time(key, match.group(3))
        if match := _CHANNEL.search(text):
            channel = channel or match.group(1)
    _check_real_header(lines[:index], checks)
    assumed = "" if fortran else "columns of ten characters, eight a line"
    event = lines[start + 2].strip() if start + 2 < index else ""
    return Record(values, step, "CSMIP V2", checks.made, assumed, channel, {"event": event} if event else {})


def _check_real_header(lines, checks):
    """Hold the last hundred real numbers before the series against it, where they are such."""
    rows = -(-_REALS // _REAL_COLUMNS)
    reals = [text for line in lines[-rows:] for text in cut_columns(line, _REAL_WIDTH)]
    if len(reals) != _REALS or None in map(plain_number, reals):
        return
    texts = {number: reals[number - 1] for number in (_LENGTH, _STEP, _TIME_OF_PEAK, _PEAK_VALUE)}
    checks.length(f"real header, entry {_LENGTH}", texts[_LENGTH])
    checks.step(f"real header, entry {_STEP}", texts[_STEP])
    checks.peak(f"real header, entry {_PEAK_VALUE}", texts[_PEAK_VALUE], 0.01)
    if float(plain_number(texts[_PEAK_VALUE])) not in (0.0, -999.0):
        checks.peak_time(f"real header, entry {_TIME_OF_PEAK}", texts[_TIME_OF_PEAK])
