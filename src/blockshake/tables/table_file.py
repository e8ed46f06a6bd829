"""Tables of users: text with any separator and decimal sign, or a sheet of a workbook; cells stay as written."""

import csv
import io
import re
import zipfile
from decimal import Decimal
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field

from blockshake.errors import InputError
from blockshake.files import read_bytes, read_foreign_text
from blockshake.tables.numbers import missing_code, plain_number
from blockshake.tables.units import UNIT_NAMES, known_unit, unit_of_name
from blockshake.validation import Strict

_SEPARATORS = "\t;|,"  # looked for in the header in this order; white space where it has none of them
GAPS = ("", "nan", "#n/a", "#nv")  # the last two as spreadsheets write them, in English and German
WORKBOOK = (".xlsx", ".xlsm")
_MOST_BYTES, _MOST_CELLS = 5e8, 2e7  # a workbook of a few kilobytes may claim any number of them
_MOST_NAMES = 20  # columns that an error lists
_RUN = 3  # rows of numbers on end, where a table begins
_MOST_HEADERS = 4  # lines of names that an error lists
SIGNS = {".": "point", ",": "comma"}
# 14:03:21,250 or 2:03:21 PM, behind any date; `datetime` objects of a workbook print so
_CLOCK = re.compile(
    r"(?:(\d[^:]{0,30}?)[T,\s]{1,3})?(\d{1,2}):([0-5]\d):([0-5]\d(?:[.,]\d{1,9})?)(?:\s?([AP])M|Z)?",
    re.ASCII | re.IGNORECASE,
)
_DAY = 86400  # s


def _lines(given):
    """Numbers of lines, from one number, several, or text between commas as an option has it."""
    if isinstance(given, str):
        return [part.strip() for part in given.split(",")]
    return given if isinstance(given, (list, tuple)) else [given]


Lines = Annotated[
    tuple[Annotated[int, Field(ge=1)], ...],
    BeforeValidator(_lines, json_schema_input_type=int | list[int]),
    Field(min_length=1),
]


class TableLayout(Strict):
    """How a table is written."""

    separator: str | None = Field(None, description="between cells; by default the one that the header shows")
    decimal: Literal[".", ","] = Field(".", description="decimal sign")
    header: Lines = Field(
        (1,),
        description="line of the columns' names, from 1, or several whose cells make a name together, with a blank "
        "between: a cell of all but the last also stands over the empty ones at its right",
    )
    data: int | None = Field(
        None, ge=1, description="first line of numbers; by default the one below the names"
    )
    last: int | None = Field(None, ge=1, description="last line of numbers; by default that of the file")


class CellTable(NamedTuple):
    """Cells of a table below its header: text, numbers, or None."""

    source: str  # file, and ``#SHEET`` of a workbook
    names: list  # of the columns; 1, 2, ... where the header's line holds numbers
    notes: list  # rows between the names and the numbers, such as units
    lines: list  # of every row in the file, from 1
    rows: list
    decimal: str
    taken: str  # where names and numbers were taken from, and where numbers begin, in words

    def column(self, name, size=Decimal(1), kind=None):
        """Numbers of a column times the size of their unit, float64 (n_rows,); NaN for an empty cell.

        ``kind`` is that of the unit; a unit in the column's name or below it must be the same.

        Raises
        ------
        InputError
            No such column, or two of that name; a cell that is no number or stands for a missing one; another unit in
            the header.

        Notes
        -----
        The product is of decimals, so that each number is the nearest one to its written digits.
        """
        cells = self._cells(name)
        if kind is not None:
            self._check_unit(name, kind, size)
        numbers = [self._number(cell, line, name) for cell, line in zip(cells, self.lines, strict=True)]
        written = np.array([np.nan if number is None else number for number in numbers], dtype=float)
        coded = None if kind == "time" else missing_code(written)
        if coded is not None:
            wrong = f"'{cells[coded]}' looks like a code for a missing one, which an empty cell states"
            raise InputError(self.source, f"line {self.lines[coded]}, {name}", f"expected a reading; {wrong}")
        try:
            values = np.array([np.nan if number is None else float(number * size) for number in numbers])
        except ArithmeticError:
            values = np.array([np.inf])
        if np.isinf(values).any():
            raise InputError(self.source, f"column '{name}'", "expected numbers of usual size")
        return values

    def place(self, name, before=None):
        """Index of a column: the only one of a name, the last one of it before another column, or by number from 1.

        Raises
        ------
        InputError
            No such column, or several.
        """
        places = [place for place, one in enumerate(self.names) if one == name]
        left = [place for place in places if before is not None and place < before]
        if len(places) == 1 or left:
            return (left or places)[-1]
        if not places and name.isascii() and name.isdigit() and 0 < int(name) <= len(self.names):
            return int(name) - 1
        others = f"there are {', '.join(filter(None, self.names[:_MOST_NAMES]))} in the header"
        if places:
            numbers = ", ".join(str(place + 1) for place in places[:_MOST_NAMES])
            others = f"it stands in the columns {numbers}, and such a number names one"
        wrong, key = f"expected this column once; {others}; {self.taken}", f"column '{name}'"
        # where there is one alone, another sign separates
        key, wrong = ("separator", f"{key}: {wrong}") if len(self.names) == 1 else (key, wrong)
        raise InputError(self.source, key, wrong)

    def times(self, name, size=Decimal(1), before=None):
        """Times of a column, float64 (n_rows,) [s], as of `column`; clocks of the day have no unit.

        Among several columns of this name it is the last one before the place ``before``. Clocks count from a midnight.
        The next day begins where the date changes or, without dates, where the clock falls by more than half a day.
        """
        if before is not None:
            name = str(self.place(name, before) + 1) if self.names.count(name) > 1 else name
        cells = self._cells(name)
        clocks = [_CLOCK.fullmatch(str(cell).strip()) for cell in cells]
        if not any(clocks):
            return self.column(name, size, "time")
        if None in clocks:
            row = clocks.index(None)
            wrong = f"expected a clock of the day such as 14:03:21.250, not '{cells[row] or ''}'"
            raise self.fault(self.lines[row], name, wrong)
        days, times, before, last = 0, [], clocks[0][1], 0
        for clock in clocks:
            date, hours, minutes, seconds, half = clock.groups()
            hours = int(hours) if half is None else int(hours) % 12 + 12 * (half in "Pp")
            now = 3600 * hours + 60 * int(minutes) + Decimal(seconds.replace(",", "."))
            days += date != before or (date is None and last - now > _DAY / 2)
            before, last = date, now
            times.append(float(_DAY * days + now))
        return np.array(times)

    def _cells(self, name):
        """Cells of a column."""
        column = self.place(name)
        return [row[column] if column < len(row) else None for row in self.rows]

    def _check_unit(self, name, kind, size):
        column = self.place(name)
        stated = [unit_of_name(self.names[column], kind)]
        noted = (str(row[column]) for row in self.notes if column < len(row) and row[column])
        stated += [known_unit(note) for note in noted if note != "min"]  # of rows of min, max and mean
        for unit in filter(None, stated):
            if unit != (kind, abs(size)):
                wrong = f"expected {UNIT_NAMES[kind, abs(size)]}; the header states {UNIT_NAMES[unit]}"
                raise InputError(self.source, f"column '{name}'", wrong)

    def fault(self, line, name, wrong, key="data"):
        """Error of a cell; in the first row, which shows whether the layout is right, of a key of `TableLayout`."""
        place = f"line {line}, {name}"
        if line != self.lines[0]:
            return InputError(self.source, place, wrong)
        return InputError(self.source, key, f"{place}: {wrong}; {self.taken}")

    def _number(self, cell, line, name):
        """A cell as a decimal, or None for a gap."""
        text = "" if cell is None else str(cell).strip()
        if text.lower() in GAPS:
            return None
        written = isinstance(cell, str)  # and not a number of a workbook
        number = cell_number(text, self.decimal) if written else plain_number(text)
        try:
            return Decimal(number)
        except ArithmeticError:
            raise self.fault(line, name, f"expected a number of usual size, not '{text}'") from None
        except TypeError:
            wrong = f"expected a number with a decimal {SIGNS[self.decimal]}, or nothing, not '{text}'"
            wrong += "; thousands have no sign between them" if {".", ","} & set(text) else ""
            swapped = cell_number(text, "." if self.decimal == "," else ",")
            raise self.fault(line, name, wrong, "decimal" if swapped else "data") from None


def cell_number(text, decimal):
    """A number with the table's decimal sign as `float` and `decimal.Decimal` read it, or None for any other text.

    A sign that is not the decimal one is never taken for it: ``1.012`` with a decimal comma, and ``1,012`` with a
    decimal point, are refused, because nothing tells thousands from a slip of the layout.
    """
    other = "." if decimal == "," else ","
    return None if other in text else plain_number(text.replace(decimal, "."))


def read_table(source, layout):
    """`CellTable` of a text file, or of a sheet of a workbook.

    Parameters
    ----------
    source : str or path
        A file; of a workbook (xlsx) with several sheets ``FILE#SHEET``.
    layout : TableLayout

    Raises
    ------
    InputError
        Missing or damaged file, unknown sheet, nothing below the header.
    """
    path, _, sheet = str(source).partition("#") if not Path(source).exists() else (source, "", "")
    path = Path(path)
    if path.suffix.lower() in WORKBOOK:
        source, rows = _sheet_rows(path, sheet)
    else:
        rows = _text_rows(path, layout)
    rows = [(line, row) for line, row in rows if any(cell not in (None, "") for cell in row)]
    wanted = layout.header[-1]
    first, header = next(((line, row) for line, row in rows if line >= wanted), (None, None))
    if header is None:
        wrong = f"expected names of columns in line {wanted}, and rows; it is empty"
        raise InputError(source, "header", wrong)
    names = ["" if cell is None else str(cell).strip() for cell in header]
    if all(cell_number(name, layout.decimal) or _CLOCK.fullmatch(name) for name in names):
        names, first = [str(number + 1) for number in range(len(names))], first - 1
    elif len(layout.header) > 1:
        names = _joined([row for line, row in rows if line in layout.header[:-1]], names)
    start = layout.data or first + 1
    below = [(line, row) for line, row in rows if start <= line <= (layout.last or line)]
    if not below:
        wrong = f"expected rows of numbers below the names in line {first}; there is none"
        raise InputError(source, "data" if layout.data else "header", wrong)
    notes = [row for line, row in rows if first < line < start]
    lines, cells = zip(*below, strict=True)
    taken = f"names are of line {', '.join(map(str, layout.header))}, numbers from line {lines[0]} on"
    taken += _begin_words(rows, lines[0], layout.decimal)
    return CellTable(str(source), names, notes, list(lines), list(cells), layout.decimal, taken)


def _joined(above, names):
    """Names whose parts stand in several lines."""
    parts = []
    for row in above:
        cells, carried = [], ""
        for cell in [*row, *[None] * (len(names) - len(row))][: len(names)]:
            carried = carried if cell in (None, "") else str(cell).strip()
            cells.append(carried)
        parts.append(cells)
    return [" ".join(filter(None, cells)) for cells in zip(*parts, names, strict=True)]


def _begin_words(rows, taken, decimal):
    """Where numbers begin, in words, if not where they were taken from, and lines above with as many cells."""

    def is_numbers(row):
        cells = [str(cell).strip() for cell in row if cell is not None]
        read = [
            cell_number(cell, decimal) or _CLOCK.fullmatch(cell) for cell in cells if cell.lower() not in GAPS
        ]
        return len(read) > 1 and all(read)

    numeric = [is_numbers(row) for _, row in rows]
    begin = next((at for at in range(len(rows) - _RUN + 1) if all(numeric[at : at + _RUN])), None)
    if begin is None or rows[begin][0] == taken:
        return ""
    width = len(rows[begin][1])
    above = [str(line) for line, row in rows[:begin] if len(row) >= width > 1][-_MOST_HEADERS:]
    words = f", but numbers begin in line {rows[begin][0]}"
    return words + (
        f" below {'lines' if len(above) > 1 else 'line'} {', '.join(above)} of as many cells" if above else ""
    )


def csv_rows(path):
    """Rows of text cells of a CSV that a spreadsheet wrote, without empty rows: the header first.

    Cells stand between commas, or between semicolons or tabs where the header has any. A decimal comma comes back as a
    point.

    Raises
    ------
    InputError
        Missing file, or numbers with a decimal comma with others with a point.
    """
    lines = read_foreign_text(path).splitlines()
    separator = next((sign for sign in "\t;" if lines and sign in lines[0]), ",")
    rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
    rows = [row for row in rows if any(row)]
    comma = next((cell for row in rows for cell in row if "," in cell and cell_number(cell, ",")), None)
    if comma is None:
        return rows
    point = next((cell for row in rows for cell in row if "." in cell and plain_number(cell)), None)
    if point is not None:
        raise InputError(path, "", f"expected one decimal sign, found '{comma}' and '{point}'")
    return [[cell_number(cell, ",") or cell for cell in row] for row in rows]


def csv_records(path):
    """Rows of a CSV as by `csv_rows`, mappings of the header's names to cells; all are named and of one length."""
    header, *rows = csv_rows(path) or [[]]
    for name in header:
        if not name or header.count(name) > 1:
            raise InputError(path, name, "expected every column to have a name of its own")
    for number, row in enumerate(rows, start=1):
        if len(row) != len(header):
            raise InputError(path, f"row {number}", f"expected {len(header)} cells, not {len(row)}")
    return [dict(zip(header, row, strict=True)) for row in rows]


def _text_rows(path, layout):
    """Lines of a text file, by number from 1, cut at the separator."""
    lines = read_foreign_text(path).splitlines()
    names = layout.header[-1]
    header = lines[names - 1] if names <= len(lines) else ""
    known = _SEPARATORS.replace(layout.decimal, "")
    separator = layout.separator or next((sign for sign in known if sign in header), " ")
    if separator.isspace() and separator != "\t":
        return _blank_rows(lines, layout, path)
    if len(separator) != 1:
        raise InputError(path, "separator", f"expected one character, not '{separator}'")
    rows = _cut(lines, separator, path)
    width = next((len(row) for number, row in rows if number >= names and any(row)), 0)
    for number, row in rows:
        # such as a decimal sign that separates
        if (layout.data or names) <= number <= (layout.last or number) and any(row[width:]):
            wrong = f"expected at most {width} cells as in line {names}, found {len(row)}"
            raise InputError(path, f"line {number}", wrong + _begin_words(rows, names + 1, layout.decimal))
    return rows


def _cut(lines, separator, path):
    """Rows of cells, by number from 1."""
    reader = csv.reader(io.StringIO("\n".join(lines)), delimiter=separator, strict=True)
    try:
        return [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        wrong = f"expected cells between '{separator}'; {error}"
        raise InputError(path, f"line {reader.line_num}", wrong) from None


def _blank_rows(lines, layout, path):
    """Lines cut at blanks, where only a row of as many cells as the header tells which one is missing."""
    rows = [(number, line.split()) for number, line in enumerate(lines, start=1)]
    filled = [(number, row) for number, row in rows if row and number >= layout.header[-1]]
    for number, row in filled:
        if (layout.data or 0) <= number <= (layout.last or number) and len(row) != len(filled[0][1]):
            wrong = f"expected {len(filled[0][1])} cells between blanks as in line {filled[0][0]}, found {len(row)}"
            first = f", {layout.data}" if layout.data else ""
            wrong += (
                f"; without names the header is the first line of numbers{first}{_seen_begin(lines, layout)}"
            )
            raise InputError(path, "header", f"line {number}: {wrong}")
    return rows


def _seen_begin(lines, layout):
    """Words on another sign between cells, where it makes numbers of lines that blanks do not."""
    for sign in _SEPARATORS.replace(layout.decimal, ""):
        rows = [(number, line.split(sign)) for number, line in enumerate(lines, start=1) if line.strip()]
        words = _begin_words(rows, 0, layout.decimal)
        if words:
            return f"; between '{sign}'{words.replace(', but', '')}".replace("\t", "tab")
    return ""


def _sheet_rows(path, sheet):
    """Rows of a sheet by number from 1, with the name of the source."""
    import openpyxl  # takes long to import

    content = io.BytesIO(read_bytes(path))
    try:
        with zipfile.ZipFile(content) as parts:
            unpacked = sum(part.file_size for part in parts.infolist())
        if unpacked > _MOST_BYTES:
            raise InputError(path, "", f"expected a workbook of at most {_MOST_BYTES:g} bytes, unpacked")
        book = openpyxl.load_workbook(content, read_only=True, data_only=True)
        names = [worksheet.title for worksheet in book.worksheets]
        if sheet not in names and (sheet or len(names) != 1):
            raise InputError(path, sheet, f"expected FILE#SHEET with one of the sheets {', '.join(names)}")
        return (f"{path}#{sheet}" if sheet else str(path)), _filled_rows(book[sheet or names[0]], path)
    except InputError:
        raise
    except Exception:  # zip, XML and key errors, whatever is damaged
        raise InputError(path, "", "expected a workbook (xlsx); this is damaged or something else") from None


def _filled_rows(sheet, path):
    """Rows of a sheet that hold anything, by number from 1."""
    sheet.reset_dimensions()  # which a file may state at will
    rows, count = [], 0
    for number, row in enumerate(sheet.iter_rows(values_only=True), start=1):
        count += len(row)
        if count > _MOST_CELLS:
            raise InputError(path, "", f"expected a sheet of at most {_MOST_CELLS:g} cells")
        if any(cell is not None for cell in row):
            rows.append((number, list(row)))
    return rows
