"""Lines of text above a series of a user: what they state of unit, step and number of values is held against it."""

import re

from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number
from blockshake.tables.units import UNIT_NAMES, known_unit, unit_of_name

_WORD = re.compile(r"[^\s;|,]+")
# before a unit of the series, of whatever letters; of one kind or another elsewhere
_NAMED = re.compile(r"units?\b(?:\s+(?:of|is|are))?(?:\s+sec(?:ond)?s?\s+and)?\s*[:=]?\s*$", re.IGNORECASE)
_IN = re.compile(r"\bin\s+$", re.IGNORECASE)
_VALUE_BEFORE, _VALUE_BEHIND = re.compile(r"\d\s*[\[(]?$"), re.compile(r"^\s*[:=]?\s*[-+.]?\d")
_PEAK = re.compile(r"\b(?:peak|max\w*|min\w*|pg[avd])\b", re.IGNORECASE)
_DISPLACED = re.compile(r"\bdis(?:p\w*)?\b", re.IGNORECASE)
_NUMBER = r"(\d+\.?\d*(?:[EeDd][-+]?\d+)?|\.\d+(?:[EeDd][-+]?\d+)?)(?![\d/])"
_STEP = re.compile(
    rf"\b(?:dt|delta[ -]?t|(?:time|sampling)\s+(?:step|interval))\b[\s:=]*(?:[\[(]\s*(\w+)\s*[\])])?[\s:=]*{_NUMBER}"
    r"\s*(ms\b|msec|milli)?",
    re.IGNORECASE,
)
_RATE = re.compile(
    rf"\bsampling\s+(?:rate|freq\w*)[\s:=]*(?:[\[(]\s*hz\s*[\])])?[\s:=]*{_NUMBER}", re.IGNORECASE
)
_ROUNDED = 0.05  # of a step, by which a header's may differ: 1/150 s as 0.007
_COUNT = re.compile(
    r"\b(?:npts?|(?:number|no\.?)\s+of\s+(?:data\s+)?(?:points|values|samples|data))[\s:=]*(\d+)(?![\d.])",
    re.IGNORECASE,
)
_DURATION = re.compile(rf"\bduration[\s:=]*{_NUMBER}", re.IGNORECASE)  # of the series, next to a count


def check_text_header(lines, where, unit, step, count):
    """Refuse a header that contradicts the unit, the step or the number of values of a series.

    Parameters
    ----------
    lines : dict of int to str
        Text above the values, by the number of its line.
    where : str
        File that a message names.
    unit : tuple of str and Decimal, or None
        Kind and size in SI of the unit that the user gives; None where a column's name states it.
    step : float, or None
        As the user gives it [s]; None where there are times.
    count : int
        Values of the file, or rows.

    Raises
    ------
    InputError
        Another unit, unless the header states the given one too; another step or sampling rate; another count.

    Notes
    -----
    A unit with a number before or behind it, or next to a word for a peak, is that of another entry.
    """
    stated = [(number, *one) for number, line in lines.items() for one in _units(line)]
    if unit is not None and stated and all(found != unit for _, found, _ in stated):
        number, found, words = stated[0]
        wrong = (
            f"expected {UNIT_NAMES[unit]}, as --unit gives; the header states {UNIT_NAMES[found]} ('{words}')"
        )
        raise InputError(where, f"line {number}", wrong)
    for number, line in lines.items():
        for interval in _steps(line) if step is not None else ():
            if abs(interval - step) > _ROUNDED * step:
                wrong = f"expected a step of {step:g} s, as --step gives; the header states {interval:g} s"
                raise InputError(where, f"line {number}", wrong)
        for match in _COUNT.finditer(line):
            if int(match[1]) != count:
                wrong = f"expected {match[1]} values, as the header states, found {count}"
                raise InputError(where, f"line {number}", wrong)


def _units(line):
    """Kind and size of every unit that a line states of the series, with the words around it."""
    for word in _WORD.finditer(line):
        before, behind = line[: word.start()], line[word.end() :]
        named = _NAMED.search(before)
        known = named or _IN.search(before)
        found = known_unit(word[0]) if known else unit_of_name(line[: word.end()])
        if found is None or found[0] not in ("acceleration", "velocity", "displacement"):
            continue
        other = _VALUE_BEFORE.search(before) or _VALUE_BEHIND.search(behind) or _PEAK.search(line)
        if not named and (other or (found[0] == "displacement" and not _DISPLACED.search(line))):
            continue
        yield found, line.strip()[:40]


def _steps(line):
    """Every step that a line states [s]; of a rate, its inverse, or itself below 1, where it is a step; of a duration
    and a count, their ratio."""
    for match in _STEP.finditer(line):
        thousandths = match[3] or (match[1] or "").lower().startswith("m")
        yield (1e-3 if thousandths else 1.0) * float(plain_number(match[2]))
    counted, lasting = _COUNT.search(line), _DURATION.search(line)
    if counted and lasting:
        yield float(plain_number(lasting[1])) / int(counted[1])
    for match in _RATE.finditer(line):
        rate = float(plain_number(match[1]))
        yield 1.0 / rate if rate > 1.0 else rate
