"""Tables of users: text with any separator and decimal sign, or a sheet of a workbook; cells stay as written."""

import csv
import io
import re
import zipfile
from decimal import Decimal
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from pydantic import Field

from blockshake.errors import InputError
from blockshake.files import read_bytes
from blockshake.validation import Strict

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_SEPARATORS = "\t;|,"  # looked for in the header in this order; white space where it has none of them
_GAPS = ("", "nan", "#n/a", "#nv")  # the last two as spreadsheets write them, in English and German
_WORKBOOK = (".xlsx", ".xlsm")
_MOST_BYTES, _MOST_CELLS = 5e8, 2e7  # a workbook of a few kilobytes may claim any number of them
_MOST_NAMES = 20  # columns that an error lists


class TableLayout(Strict):
    """How a table is written."""

    separator: str | None = Field(None, description="between cells; by default the one that the header shows")
    decimal: Literal[".", ","] = Field(".", description="decimal sign")
    header: int = Field(1, ge=1, description="line of the columns' names, from 1")
    data: int | None = Field(
        None, ge=1, description="first line of numbers; by default the one below the names"
    )


class Table(NamedTuple):
    """Cells of a table below its header.

    Attributes
    ----------
    source : str
        File, and ``#SHEET`` of a workbook.
    names : list of str
        Of the columns; 1, 2, ... where the header's line holds numbers.
    lines : list of int
        Line of every row in the file.
    rows : list of list
        Cells: text, numbers, or None.
    decimal : str
    """

    source: str
    names: list
    lines: list
    rows: list
    decimal: str

    def column(self, name, size=Decimal(1)):
        """Numbers of a column times the size of their unit, float64 (n_rows,); NaN for an empty cell.

        Raises
        ------
        InputError
            No such column, or two of that name; a cell that is no number.

        Notes
        -----
        The product is of decimals, so that each number is the nearest one to its written digits.
        """
        if self.names.count(name) != 1:
            found = (
                "it stands twice"
                if name in self.names
                else f"there are {', '.join(self.names[:_MOST_NAMES])}"
            )
            raise InputError(self.source, f"column '{name}'", f"expected this column once; {found}")
        place = self.names.index(name)
        cells = (row[place] if place < len(row) else None for row in self.rows)
        return np.array([
            self._number(cell, size, f"line {line}, {name}") for line, cell in zip(self.lines, cells, strict=True)
        ])  # fmt: skip

    def _number(self, cell, size, key):
        if isinstance(cell, (int, float)) and not isinstance(cell, bool):
            cell = repr(cell)
        text = "" if cell is None else str(cell).strip()
        if text.lower() in _GAPS:
            return np.nan
        plain = text.replace(",", ".") if self.decimal == "," and "." not in text else text
        if not _NUMBER.fullmatch(plain):
            sign = {".": "point", ",": "comma"}[self.decimal]
            raise InputError(
                self.source, key, f"expected a number with a decimal {sign}, or nothing, not '{text}'"
            )
        try:
            return float(Decimal(plain) * size)
        except ArithmeticError:
            raise InputError(self.source, key, f"expected a number of usual size, not '{text}'") from None


def read_table(source, layout):
    """`Table` of a text file, or of a sheet of a workbook.

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
    path, _, sheet = str(source).partition("#") if not Path(source).exists() else (str(source), "", "")
    if Path(path).suffix.lower() in _WORKBOOK:
        source, rows = _sheet_rows(Path(path), sheet)
    else:
        rows = _text_rows(Path(path), layout)
    rows = [(line, row) for line, row in rows if any(cell not in (None, "") for cell in row)]
    header = next((row for line, row in rows if line >= layout.header), None)
    if header is None:
        raise InputError(
            source, "", f"expected names of columns in line {layout.header}, and rows; it is empty"
        )
    first = next(line for line, _ in rows if line >= layout.header)
    names = ["" if cell is None else str(cell).strip() for cell in header]
    decimal = layout.decimal
    if all(_NUMBER.fullmatch(name.replace(decimal, ".")) for name in names):
        names, first = [str(number + 1) for number in range(len(names))], first - 1
    below = [(line, row) for line, row in rows if line >= (layout.data or first + 1)]
    if not below:
        raise InputError(
            source, "", f"expected rows of numbers below the names in line {first}; there is none"
        )
    return Table(str(source), names, [line for line, _ in below], [row for _, row in below], decimal)


def _text_rows(path, layout):
    """Lines of a text file, by number from 1, cut at the separator."""
    content = read_bytes(path)
    try:
        text = content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", errors="replace")  # as spreadsheets on Windows write it
    lines = text.splitlines()
    header = lines[layout.header - 1] if layout.header <= len(lines) else ""
    known = _SEPARATORS.replace(layout.decimal, "")
    separator = layout.separator or next((one for one in known if one in header), " ")
    if separator.isspace() and separator != "\t":
        return [(number, line.split()) for number, line in enumerate(lines, start=1)]
    if len(separator) != 1:
        raise InputError(path, "separator", f"expected one character, not '{separator}'")
    reader = csv.reader(io.StringIO("\n".join(lines)), delimiter=separator, strict=True)
    try:
        return [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        raise InputError(
            path, f"line {reader.line_num}", f"expected cells between '{separator}'; {error}"
        ) from None


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
        names = [one.title for one in book.worksheets]
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
