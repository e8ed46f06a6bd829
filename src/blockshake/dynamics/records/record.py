"""Common result of all record formats: a uniform acceleration series in SI, and its metadata."""

from dataclasses import dataclass, field

import numpy as np

from blockshake.errors import InputError

STANDARD_GRAVITY = 9.80665  # m/s2, ISO 80000-3; the g of record files

_ACCELERATION_UNITS = {
    "m/s^2": 1.0,
    "m/s2": 1.0,
    "m/s/s": 1.0,
    "m/sec2": 1.0,
    "m/sec^2": 1.0,
    "m/sec/sec": 1.0,
    "cm/s^2": 0.01,
    "cm/s2": 0.01,
    "cm/s/s": 0.01,
    "cm/sec2": 0.01,
    "cm/sec^2": 0.01,
    "cm/sec/sec": 0.01,
    "gal": 0.01,
    "g": STANDARD_GRAVITY,
}


@dataclass(frozen=True)
class Record:
    """One recorded component.

    Attributes
    ----------
    acceleration : float64 array, shape (n_rows,)
        As recorded, no correction made here [m/s2].
    time_step : float
        [s]
    format : str
        Name of the file format.
    metadata : dict of str to str
        What the header says of event, station and processing; ``licence`` where stated.
    """

    acceleration: np.ndarray
    time_step: float
    format: str
    metadata: dict = field(default_factory=dict)


def acceleration_unit(text, where, key):
    """Size in m/s2 of the unit of acceleration that a header names.

    Raises
    ------
    InputError
        The unit is not one of cm/s2, m/s2 and g, in any usual spelling.
    """
    unit = text.strip().lower().replace(" ", "")
    if unit not in _ACCELERATION_UNITS:
        raise InputError(
            where, key, f"expected a unit of acceleration (cm/s^2, m/s^2 or g), found '{text.strip()}'"
        )
    return _ACCELERATION_UNITS[unit]


def positive_number(text, where, key, kind=float):
    """A header's number, finite and above zero.

    Raises
    ------
    InputError
        The text is no such number.
    """
    try:
        number = kind(text)
    except ValueError:
        number = 0
    if not (0 < number < np.inf):
        raise InputError(
            where,
            key,
            f"expected a positive {'integer' if kind is int else 'number'}, found '{text.strip()}'",
        )
    return number


def values_of(tokens_by_line, count, where, count_key):
    """Series of values from the data lines of a file.

    Parameters
    ----------
    tokens_by_line : iterable of (int, list of str)
        Line number in the file, from 1, and the numbers on that line as text.
    count : int
        How many values the header promises.
    where, count_key : str
        File and header entry that a message names.

    Returns
    -------
    float64 array, shape (count,)
        In the file's unit.

    Raises
    ------
    InputError
        A value is not a finite number, or there are more or fewer than ``count``, or fewer than two.
    """
    values = []
    for line, tokens in tokens_by_line:
        for token in tokens:
            values.append(finite_number(token, where, f"line {line}"))
    if len(values) != count:
        raise InputError(where, count_key, f"expected {count} values, found {len(values)}")
    if count < 2:
        raise InputError(where, count_key, f"expected at least two values, found {count}")
    return np.array(values)


def finite_number(text, where, key):
    """A finite number written as text.

    Raises
    ------
    InputError
        The text is no number, or is NaN or infinite.
    """
    try:
        number = float(text)
    except ValueError:
        number = np.nan
    if not np.isfinite(number):
        raise InputError(where, key, f"expected a finite number, found '{text.strip()}'")
    return number
