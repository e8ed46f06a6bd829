"""Series of values without times, one or several a line, as many programs print a motion."""

import numpy as np

from blockshake.errors import InputError
from blockshake.files import read_foreign_text
from blockshake.tables.numbers import missing_code, touching_numbers
from blockshake.tables.table_file import cell_number

_FIRST = 4  # values in which a count or a step of a header may stand
_FEWEST_COUNTED = 20  # values that a header counts; a smaller number may be a value


def values_in_order(path, layout, step):
    """All values of a text file, line by line.

    Parameters
    ----------
    path : str or path
    layout : TableLayout
        Its ``data`` is the first line of values, by default the first that holds numbers alone.
    step : float
        As the user gives it [s]; a value that equals it at the start is one of a header.

    Returns
    -------
    values : float64 array, shape (n_values,)
    said : str
        Lines, and values a line, that were read.
    above : dict of int to str
        Lines above the values, by their numbers.

    Raises
    ------
    InputError
        No values; text below them; lines of other lengths but the last; a first value that counts the others or is
        their step.
    """
    lines = read_foreign_text(path).splitlines()
    read = {}
    for number, line in enumerate(lines, start=1):
        if number >= (layout.data or 1) and line.strip():
            numbers = _numbers(line, layout)
            if numbers:
                read[number] = numbers
            elif layout.data or read:
                raise InputError(path, f"line {number}", f"expected values alone, not '{line.strip()[:40]}'")
    if not read:
        raise InputError(path, "data", "expected a line of numbers alone")
    first, last = next(iter(read)), list(read)[-1]
    usual = max(len(numbers) for numbers in read.values())
    for number, numbers in read.items():
        if len(numbers) != usual and number != last:
            wrong = f"expected {usual} values, as in other lines, found {len(numbers)}; --data names the first line"
            raise InputError(path, f"line {number}", wrong)
    values = np.concatenate([np.array(numbers) for numbers in read.values()])
    for index, value in enumerate(values[:_FIRST] if layout.data is None else ()):
        counts = len(values) - 1 - index - np.arange(_FIRST)  # of others, behind a step and a start
        if value == step or (value in counts and value >= _FEWEST_COUNTED):
            wrong = f"expected a value, found {value:g}, {'the step' if value == step else 'the number of the others'}"
            raise InputError(
                path, f"line {first + index // usual}", f"{wrong}; --data names the first line of values"
            )
    coded = missing_code(values)
    if coded is not None:
        raise InputError(path, "", f"expected values; {values[coded]:g} looks like a code for a missing one")
    above = dict(enumerate(lines[: first - 1], start=1))
    return values, f"values of lines {first} to {last}, {usual} a line", above


def _numbers(line, layout):
    """Numbers of a line that holds nothing else; none of another line."""
    for sign in ("\t", ";", *("," * (layout.decimal == "."))):
        line = line.replace(layout.separator or sign, " ")
    texts = [text for cell in line.split() for text in touching_numbers(cell) or [cell]]
    numbers = [cell_number(text, layout.decimal) for text in texts]
    return [float(number) for number in numbers] if all(numbers) else []
