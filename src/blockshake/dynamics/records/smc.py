"""SMC of the U.S. Geological Survey: eleven lines of text, 48 whole and 50 real numbers, comments, fixed columns.

Facts of the format: USGS National Strong-Motion Project, SMC-format data files; Boore's programs of time-series
processing, whose entry 47 tells the files of higher precision.
"""

import re

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import (
    Record,
    cut_columns,
    finite_number,
    fixed_values,
    positive_number,
)
from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number

_TEXT_LINES = 11
_WHOLE = (48, 8, 10)  # numbers, columns, width
_REAL = (50, 5, 15)
_KINDS = ("1 UNCORRECTED ACCELEROGRAM", "2 CORRECTED ACCELEROGRAM")
_USUAL, _PRECISE = (8, 10), (5, 14)  # columns and width of the values; entry 47 is 8 for the second
_UNIT = 0.01  # m/s2 of cm/s2, which the format prescribes
_COMMENTS, _COUNT, _PRECISION = 16, 17, 47  # whole numbers, from 1
_UNKNOWN, _RATE = 1, 2  # real numbers, from 1, as the next
_MAXIMUM_TIME, _MAXIMUM, _MINIMUM_TIME, _MINIMUM = 29, 30, 31, 32
_PEAK = re.compile(r"\bpk\s*=\s*(\S+)")


def is_smc(text):
    """Whether a text looks like an SMC file: a kind in line 1, and whole numbers from line 12 on."""
    lines = text.split("\n", _TEXT_LINES + 1)
    return (
        len(lines) > _TEXT_LINES
        and re.match(r"\s*(\*|[0-9] [A-Z])", lines[0]) is not None
        and re.fullmatch(r"(?:[ \d-]{9}\d){8}\s*", lines[_TEXT_LINES]) is not None
    )


def read_smc(text, where):
    """Records, a list of one, from the text of an SMC file of acceleration.

    Raises
    ------
    InputError
        The file holds something else, is cut short, a value is not a finite number; or an extreme value, its time or
        the peak in line 7 contradicts the values.
    """
    lines = text.split("\n")
    kind = lines[0].strip() if lines else ""
    if kind.upper() not in _KINDS:
        raise InputError(where, "line 1", f"expected {' or '.join(_KINDS)}, found '{kind}'")
    first = _TEXT_LINES
    whole = _header(lines, first, _WHOLE, where, "whole numbers")
    first += _WHOLE[0] // _WHOLE[1]
    real = _header(lines, first, _REAL, where, "real numbers")
    first += _REAL[0] // _REAL[1]
    comments = finite_number(whole[_COMMENTS - 1], where, f"whole number {_COMMENTS}")
    first += max(int(comments), 0)
    count = positive_number(whole[_COUNT - 1], where, f"whole number {_COUNT}", int)
    step = 1.0 / positive_number(real[_RATE - 1], where, f"real number {_RATE}")
    layout = _PRECISE if plain_number(whole[_PRECISION - 1]) == "8" else _USUAL
    values = _UNIT * fixed_values(lines, first, count, layout, where, f"whole number {_COUNT}")
    checks = HeaderChecks(where, values, step)
    known = [
        None if float(plain_number(text) or "nan") == float(real[_UNKNOWN - 1]) else text for text in real
    ]
    for entry, time, sign in ((_MAXIMUM, _MAXIMUM_TIME, 1), (_MINIMUM, _MINIMUM_TIME, -1)):
        checks.extreme(f"real number {entry}", known[entry - 1], _UNIT)
        if known[entry - 1] is not None:
            checks.peak_time(f"real number {time}", known[time - 1], sign)
    stated = _PEAK.search(lines[6])
    checks.peak("line 7", stated.group(1) if stated else None, _UNIT)
    station, _, direction = lines[5].partition("component")
    metadata = {"event": lines[3].strip(), "station": station.strip(), "stream": direction.strip(" =:")}
    return [Record(values, step, "USGS SMC", checks.made, "cm/s2, the unit of the format", metadata=metadata)]


def _header(lines, first, layout, where, name):
    """Texts of the numbers of a header."""
    count, columns, width = layout
    texts = [text for line in lines[first : first + count // columns] for text in cut_columns(line, width)]
    if len(texts) != count:
        wrong = f"expected {count} {name} from here on, found {len(texts)}"
        raise InputError(where, f"line {first + 1}", wrong)
    return texts
