"""Units that files of users may have, and their sizes in SI as exact decimals: digits stay as they were written."""

from decimal import Decimal

from blockshake.errors import InputError

_CENTI, _MILLI, _MICRO = Decimal("0.01"), Decimal("0.001"), Decimal("0.000001")
STANDARD_GRAVITY = Decimal("9.80665")  # m/s2, ISO 80000-3; the g of record files
_DEGREE = Decimal("0.01745329251994329577")  # rad
_SQUARED = ("/s^2", "/s2", "/s/s", "/sec2", "/sec^2", "/sec/sec", "/s**2")
UNITS = {
    "time": {"s": Decimal(1), "ms": _MILLI, "min": Decimal(60)},
    "displacement": {"m": Decimal(1), "cm": _CENTI, "mm": _MILLI, "um": _MICRO},
    "velocity": {"m/s": Decimal(1), "cm/s": _CENTI, "mm/s": _MILLI},
    "acceleration": {
        **{
            prefix + spelt: size
            for prefix, size in (("m", Decimal(1)), ("cm", _CENTI), ("mm", _MILLI))
            for spelt in _SQUARED
        },
        "gal": _CENTI,
        "g": STANDARD_GRAVITY,
    },
    "rotation": {"rad": Decimal(1), "mrad": _MILLI, "deg": _DEGREE},
}
_SHOWN = {kind: ", ".join(units) for kind, units in UNITS.items()} | {"acceleration": "cm/s^2, m/s^2 or g"}


def unit_size(kind, text, where, key):
    """Size in SI of a unit of a kind of quantity, in any usual spelling, as a `decimal.Decimal`.

    Raises
    ------
    InputError
        Another unit.
    """
    unit = text.strip().lower().replace(" ", "").replace("\N{MICRO SIGN}", "u")
    if unit not in UNITS[kind]:
        raise InputError(where, key, f"expected a unit of {kind} ({_SHOWN[kind]}), found '{text.strip()}'")
    return UNITS[kind][unit]


def kind_of_unit(text, kinds, where, key):
    """Kind of quantity, among ``kinds``, that a unit measures.

    Raises
    ------
    InputError
        None of them.
    """
    unit = text.strip().lower().replace(" ", "")
    for kind in kinds:
        if unit in UNITS[kind]:
            return kind
    shown = "; ".join(f"of {kind} {_SHOWN[kind]}" for kind in kinds)
    raise InputError(where, key, f"expected a unit {shown}; found '{text.strip()}'")
