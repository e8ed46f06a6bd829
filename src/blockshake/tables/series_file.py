"""Values of users without times: one column, or many values a line, below any text."""

import re

import numpy as np

from blockshake.errors import InputError
from blockshake.files import read_foreign_text
from blockshake.tables.numbers import missing_code, plain_number, touching_numbers
from blockshake.tables.table_file import GAPS, SIGNS, WORKBOOK, cell_number, path_and_sheet, sheet_rows

_SENTENCE = re.compile(r"=|\b(?:of|in)\b", re.IGNORECASE)  # in a line that is no line of names
_TIMES = 4  # steps up without one down, which are times and no motion


def read_series(source, layout):
    """Values of a file that gives no times, row by row, and the text above them.

    Parameters
    ----------
    source : str or path
        A file, or ``FILE#SHEET`` of a workbook with several sheets.
    layout : TableLayout
        ``data`` is the first line of values; by default the first one that holds numbers alone.

    Returns
    -------
    values : float64 array, shape (n_values,)
        As written.
    header : str
    width : int
        Values a line.

    Raises
    ------
    InputError
        Missing or damaged file; no values; text among them; rows of different lengths but for the last; names above
        columns; a column that counts as times do; a first value that is the number of the others; a value that stands
        for a missing one.
    """
    source, rows = _rows(source, layout)
    lines, values, lengths, header = [], [], [], []
    expected = f"numbers with a decimal {SIGNS[layout.decimal]} between blanks, or --separator and --decimal"
    for line, cells in rows:
        if line < (layout.data or 1) or (not lines and layout.data is None and _is_text(cells)):
            header.append(" ".join(map(str, cells)))
            continue
        numbers = _numbers(cells, layout.decimal)
        if numbers is None:
            wrong = f"expected {expected}, not '{' '.join(map(str, cells))}'"
            raise InputError(source, f"line {line}", wrong)
        lines.append(line)
        lengths.append(len(numbers))
        values += numbers
    if len(values) < 2:
        raise InputError(source, "", f"expected at least two {expected}, found {len(values)}")
    values = np.array(values)
    _check_rows(source, lines, values, lengths)
    names = header[-1].split() if header and layout.data is None else []
    if len(names) == lengths[0] > 1 and not _SENTENCE.search(header[-1]):
        wrong = f"expected values of one motion, not columns {', '.join(names)}: --column chooses, or --data"
        raise InputError(source, f"line {lines[0]}", f"{wrong} says where values begin")
    coded = missing_code(values)
    if coded is not None:
        line = lines[int(np.searchsorted(np.cumsum(lengths), coded, side="right"))]
        wrong = f"expected a value; {values[coded]:g} looks like a code for none"
        raise InputError(source, f"line {line}", wrong)
    return values, "\n".join(header), lengths[0]


def _rows(source, layout):
    """Name of the source, and cells of every row that has some, by its number from 1."""
    path, sheet = path_and_sheet(source)
    if path.suffix.lower() in WORKBOOK:
        source, rows = sheet_rows(path, sheet)
    else:
        blank = (layout.separator or "").isspace()
        signs = "\t;|" if blank or not layout.separator else layout.separator
        table = str.maketrans(dict.fromkeys(signs, " "))
        lines = read_foreign_text(path).split("\n")
        rows = enumerate((line.translate(table).split() for line in lines), start=1)
    filled = ((number, [cell for cell in row if cell not in (None, "")]) for number, row in rows)
    return source, [(number, cells) for number, cells in filled if cells]


def _check_rows(source, lines, values, lengths):
    """Refuse rows of different lengths but for the last, a number of values before them, and times among them."""
    width = lengths[0]
    uneven = [row for row in range(1, len(lines)) if lengths[row] != width]
    if uneven and (uneven[0] < len(lines) - 1 or lengths[-1] > width):
        wrong = f"expected {width} values as in line {lines[0]}, found {lengths[uneven[0]]}"
        raise InputError(source, f"line {lines[uneven[0]]}", f"{wrong}; --data says where they begin")
    if len(values) - values[0] in (1, 2):
        wrong = f"expected a value; {values[0]:g} is the number of those that follow"
        raise InputError(source, f"line {lines[0]}", f"{wrong}: --data says where they begin")
    for column in range(width if width > 1 else 0):
        steps = np.diff(values[column::width])
        if len(steps) >= _TIMES and steps.min() > 0.0:
            name = "the first column" if column == 0 else f"column {column + 1}"
            wrong = f"expected values alone; {name} counts as times do: --time and --column name columns"
            raise InputError(source, "", wrong)


def _is_text(cells):
    """Whether a row is of a header: a cell of it is a word."""
    words = (str(cell).strip().lower() for cell in cells)
    return any(word[:1].isalpha() and word not in GAPS for word in words)


def _numbers(cells, decimal):
    """Values of a row, or None where a cell is anything else."""
    values = []
    for cell in cells:
        if isinstance(cell, (int, float)) and not isinstance(cell, bool):
            values.append(float(cell))
            continue
        number = cell_number(str(cell), decimal)
        texts = [number] if number else touching_numbers(str(cell)) if decimal == "." else None
        if texts is None:
            return None
        values += [float(plain_number(text)) for text in texts]
    return values if np.isfinite(values).all() else None
