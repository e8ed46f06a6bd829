"""Units that files of users may have, and their sizes in SI as exact decimals: digits stay as they were written."""

import re
import unicodedata
from decimal import Decimal

from blockshake.errors import InputError

_CENTI, _MILLI, _MICRO = Decimal("0.01"), Decimal("0.001"), Decimal("0.000001")
STANDARD_GRAVITY = Decimal("9.80665")  # m/s2, ISO 80000-3; the g of record files
_DEGREE = Decimal("0.01745329251994329577")  # rad
UNITS = {
    "time": {"s": Decimal(1), "ms": _MILLI, "min": Decimal(60)},
    "displacement": {"m": Decimal(1), "cm": _CENTI, "mm": _MILLI, "um": _MICRO},
    "velocity": {"m/s": Decimal(1), "cm/s": _CENTI, "mm/s": _MILLI},
    "acceleration": {
        "m/s2": Decimal(1), "cm/s2": _CENTI, "mm/s2": _MILLI, "gal": _CENTI, "g": STANDARD_GRAVITY,
        "mg": STANDARD_GRAVITY * _MILLI, "%g": STANDARD_GRAVITY * _CENTI, "g/10": STANDARD_GRAVITY * Decimal("0.1"),
    },
    "rotation": {"rad": Decimal(1), "mrad": _MILLI, "deg": _DEGREE},
}  # fmt: skip
# the first of each size
UNIT_NAMES = {(kind, units[unit]): unit for kind, units in UNITS.items() for unit in reversed(units)}
_SHOWN = {kind: ", ".join(units) for kind, units in UNITS.items()}
_SECOND = re.compile(r"sec(?:ond)?s?(?![a-z])")
_PER_SECOND_SQUARED = re.compile(r"/s/s$|/\(s2\)$|(?<=m)(?:[/_p]|per)?s-?2$")
_MOST_WORDS = 5  # of a unit: CM / SEC / SEC
# behind a unit: begins with a factor, or has the word for it anywhere
_FACTOR = re.compile(
    r"^[(\[,;\s-]*[x*/\d\N{MULTIPLICATION SIGN}]|\btimes\s+[\d.]|\bmult|\bscal|\bsf\s*=|\bfactor",
    re.IGNORECASE,
)
_COSMOS_CODE = re.compile(r"\(\s*0*(\d+)\s*\)\s*$")
_OF_CODE = {"2": "g", "4": "cm/s2"}  # COSMOS format 1.20, table 2
# a unit in a column's name: in brackets, or behind a blank or another sign that is not behind a value
_IN_BRACKETS = re.compile(r"[\[({<]([^\[\]()]*(?:\([^()]*\))?[^\[\]()]*)[\])}>]\s*$")
_BEFORE = re.compile(r"^|[\s_/,:;=-]+")
_VALUE = re.compile(r"(?:^|[\s=:])[-+.\d]+(?:e[-+]?\d+)?$", re.IGNORECASE)


def _plain(text):
    """A unit in the spelling of `UNITS`, whatever its case, blanks, brackets, powers and punctuation."""
    unit = unicodedata.normalize("NFKC", text).lower().replace("\N{GREEK SMALL LETTER MU}", "u")
    if code := _COSMOS_CODE.search(unit):
        coded, named = _OF_CODE.get(code.group(1)), _plain(unit[: code.start()])
        return coded if coded and named in ("", coded) else text
    unit = _SECOND.sub("s", unit.replace("\N{MINUS SIGN}", "-").replace("**", ""))
    unit = re.sub(
        r"[\s\[\]{}\"'`\N{RIGHT SINGLE QUOTATION MARK}.,;:^*\N{MIDDLE DOT}\N{DOT OPERATOR}]", "", unit
    )
    if unit.startswith("(") and unit.endswith(")"):
        unit = unit[1:-1]
    unit = _PER_SECOND_SQUARED.sub("/s2", unit)
    return {"gs": "g", "gals": "gal", "millis": "ms", "millig": "mg", "milli-g": "mg"}.get(unit, unit)


def unit_size(kind, text, where, key):
    """Size in SI of a unit of a kind of quantity, in any usual spelling, as a `decimal.Decimal`.

    Raises
    ------
    InputError
        Another unit.
    """
    unit = _plain(text)
    if unit not in UNITS[kind]:
        raise InputError(where, key, f"expected a unit of {kind} ({_SHOWN[kind]}), found '{text.strip()}'")
    return UNITS[kind][unit]


def leading_unit(kind, text, where, key):
    """Size in SI of the unit that a text begins with, as `unit_size`; further words may follow it."""
    words = text.split()
    for count in range(min(_MOST_WORDS, len(words)), 0, -1):
        unit = _plain(" ".join(words[:count]))
        if unit in UNITS[kind] and not _FACTOR.search(" ".join(words[count:])):
            return UNITS[kind][unit]
    return unit_size(kind, text, where, key)


def kind_of_unit(text, kinds, where, key):
    """Kind of quantity, among ``kinds``, that a unit measures.

    Raises
    ------
    InputError
        None of them.
    """
    unit = _plain(text)
    for kind in kinds:
        if unit in UNITS[kind]:
            return kind
    shown = "; ".join(f"of {kind} {_SHOWN[kind]}" for kind in kinds)
    raise InputError(where, key, f"expected a unit {shown}; found '{text.strip()}'")


def unit_of_name(name, kind=None):
    """Kind and size in SI of the unit that a name of a column ends with, such as ``EW [cm/s2]`` or ``acc_g``; or None.

    Outside of brackets a unit of one letter is one of the ``kind`` alone, since other words end so.
    """
    match = _IN_BRACKETS.search(name)
    if match:
        return known_unit(match.group(1))
    for before in _BEFORE.finditer(name):
        text = name[before.end() :]
        unit = None if _VALUE.search(name[: before.start()]) else known_unit(text)
        if unit and (unit[0] == kind or (len(text.strip()) > 1 and text.lower() != "min")):
            return unit
    return None


def known_unit(text):
    """Kind and size in SI of a unit, or None for any other text."""
    unit = _plain(text)
    return next(((kind, units[unit]) for kind, units in UNITS.items() if unit in units), None)
