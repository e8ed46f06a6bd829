"""Common result of all record formats: a uniform acceleration series in SI, and its metadata."""

from dataclasses import dataclass, field

import numpy as np

from blockshake.errors import InputError
from blockshake.tables.units import unit_size


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
    return float(unit_size("acceleration", text, where, key))


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
