"""Numbers as files write them, and values that stand for none."""

import re

import numpy as np

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?", re.ASCII)
# Fortran prints numbers without a blank between them: the sign of the next one ends the last
_TOUCHING = re.compile(rf"{_NUMBER.pattern}(?=[-+]|$)", re.ASCII)
# codes of loggers and databases for a missing value, and how far they stand out of the values around them
_CODES = (
    99.99, 999.0, 9999.0, 99999.0, 999999.0, 999.9, 9999.9, 99999.9, 9999.99, 999999.999, 999.25, 8888.0, 32768.0,
    2147483647.0,
)  # fmt: skip
_NO_MOTION = 1e20  # from which on every value is a code: 1e20, 1e35, 9.96921e36 of netCDF
_STANDS_OUT = 3.0
_FAR_JUMP, _USUAL_SHARE = 3.0, 0.99  # of a code among fractions: jumps beyond nearly all others


def plain_number(text):
    """A number as `float` and `decimal.Decimal` read it, or None for any other text.

    ASCII digits with a decimal point; an exponent after E, or after D as Fortran writes it.
    """
    text = text.strip()
    return re.sub("[Dd]", "E", text) if _NUMBER.fullmatch(text) else None


def touching_numbers(text):
    """Texts of the numbers in a text without blanks, such as ``-.12E+01-.45E+01``, or None for any other text."""
    numbers = [match.group() for match in _TOUCHING.finditer(text)]
    return numbers if numbers and "".join(numbers) == text else None


def missing_code(values):
    """Index of a value that stands for a missing one, such as -999 among values below 100; None where there is none.

    Parameters
    ----------
    values : float64 array, shape (n_rows,)
        As written, before any unit; NaN is no value.
    """
    magnitude = np.abs(values)
    coded = np.isin(magnitude, _CODES) | (magnitude >= _NO_MOTION)
    rows = np.flatnonzero(~coded & np.isfinite(magnitude))
    if not coded.any() or not len(rows):
        return None
    out = coded & (magnitude >= _STANDS_OUT * magnitude[rows].max())
    others = values[rows]
    if len(others) > 2 and (others % 1.0).any():
        codes = np.flatnonzero(coded)
        behind = np.searchsorted(rows, codes)
        before, after = others[np.maximum(behind - 1, 0)], others[np.minimum(behind, len(rows) - 1)]
        jumps = np.minimum(np.abs(values[codes] - before), np.abs(values[codes] - after))
        out[codes] |= jumps > _FAR_JUMP * np.quantile(np.abs(np.diff(others)), _USUAL_SHARE)
    return int(np.argmax(out)) if out.any() else None
