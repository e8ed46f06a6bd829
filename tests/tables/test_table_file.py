"""Tables as users write them: digits stay, faults get one line."""

from datetime import datetime, time, timedelta
from decimal import Decimal

import numpy as np
import openpyxl
import pytest

from blockshake.errors import InputError
from blockshake.tables.table_file import TableLayout, csv_rows, read_table
from blockshake.tables.units import unit_size

MM = unit_size("displacement", "mm", "here", "unit")


def _column(path, name, size=Decimal(1), **layout):
    return read_table(path, TableLayout(**layout)).column(name, size).tolist()


@pytest.mark.parametrize(
    ("text", "layout"),
    [
        ("t,a b\n0,1.5\n0.1,-2e-3\n", {}),
        ("t;a b\n0;1,5\n0,1;-2e-3\n", {"decimal": ","}),
        ("t\ta b\r\n0\t1,5\r\n0,1\t-2e-3\r\n", {"decimal": ","}),
        ("t|a b\n0|1.5\n\n0.1|-2e-3\n", {}),
        ("logger 7\nt;a b\ns;mm\n0;1.5\n0.1;-2e-3\n", {"header": 2, "data": 4}),
        ('"t","a b"\n"0","1,5"\n"0,1","-2e-3"\n', {"separator": ",", "decimal": ","}),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_a_text_with_any_separator(text, layout, encoding, tmp_path):
    (tmp_path / "t.csv").write_bytes(text.replace("a b", "Prüfkörper").encode(encoding))
    assert _column(tmp_path / "t.csv", "Prüfkörper", **layout) == [1.5, -2e-3]


@pytest.mark.parametrize(
    ("text", "cells"),
    [
        ("a,b\n1.5, x\n,\n", [["a", "b"], ["1.5", "x"]]),
        ("a;b\n1,5;x,5\n", [["a", "b"], ["1.5", "x,5"]]),
        ('a,b\n"1,5",-2\n', [["a", "b"], ["1.5", "-2"]]),
        ("", []),
    ],
)
def test_rows_of_a_spreadsheet(text, cells, tmp_path):
    (tmp_path / "t.csv").write_text(text)
    assert csv_rows(tmp_path / "t.csv") == cells


def test_columns_without_names_are_counted(tmp_path):
    (tmp_path / "t.txt").write_text("  0.0   0.5\n 0.01  0.25\n")
    assert _column(tmp_path / "t.txt", "2") == [0.5, 0.25]


def test_a_number_is_the_nearest_to_its_digits_in_its_unit(tmp_path):
    """0.9 mm times 1e-3 in binary is one unit in the last place off 0.0009."""
    (tmp_path / "t.csv").write_text("t,a\n0,0.9\n1,\n2,NaN\n")
    read = _column(tmp_path / "t.csv", "a", MM)
    assert read[0] == 0.0009 != 0.9 * 1e-3
    assert np.isnan(read[1:]).all()


def _book(path, **sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def test_a_workbook(tmp_path):
    one = [["t", "a"], [0.0, 1.1], [0.1, None], [0.2, "2.5"]]
    path = _book(tmp_path / "b.xlsx", first=one)
    assert _column(path, "a", MM)[::2] == [0.0011, 0.0025]
    path = _book(tmp_path / "b.xlsx", first=one, second=[["t", "a"], [0, 7]])
    assert _column(f"{path}#second", "a") == [7.0]


def test_sheets_and_files_that_hold_no_table(tmp_path):
    path = _book(tmp_path / "b.xlsx", empty=[], one=[["t", "a"]])
    (tmp_path / "no.xlsx").write_text("t,a\n")
    for source, message in (
        (f"{path}#empty", "expected names of columns in line 1, and rows; it is empty"),
        (f"{path}#one", "expected rows of numbers below the names in line 1; there is none"),
        (f"{path}#two", "two: expected FILE#SHEET with one of the sheets empty, one"),
        (path, "expected FILE#SHEET with one of the sheets empty, one"),
        (tmp_path / "no.xlsx", "expected a workbook"),
        (tmp_path / "nothing.csv", "expected a readable file"),
    ):
        with pytest.raises(InputError, match=message):
            read_table(source, TableLayout())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,b,\n0,1\n", "column 'a': expected this column once; there are t, b in the header"),
        ("t-b\n0-1\n", "separator: column 'a': expected this column once; there are t-b in the header"),
        ("t,a,a\n0,1,1\n", "column 'a': expected this column once; it stands in the columns 2, 3"),
        ("t,a\n0,1\n1,far\n", "line 3, a: expected a number with a decimal point, or nothing, not 'far'"),
        ("t;a\n0;1,5\n", "decimal: line 2, a: expected a number with a decimal point, or nothing, not '1,5'"),
        ("t;a\ns;mm\n0;1\n", "data: line 2, a: expected a number"),
        ("t,a\n0,1_0\n", "line 2, a: expected a number"),
        ('t,a\n0,"1\n', "expected cells between ','"),
    ],
)
def test_faults_of_a_table_name_their_place(text, message, tmp_path):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(InputError, match=r"t\.csv") as error:
        _column(tmp_path / "t.csv", "a")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_text_of_a_workbook_has_the_table_s_decimal_sign(tmp_path):
    path = _book(tmp_path / "b.xlsx", one=[["t", "a"], [0.5, "1,5"], [1.5, "1.012"]])
    assert _column(path, "t", decimal=",") == [0.5, 1.5]  # a number has no sign to take for another
    with pytest.raises(InputError, match="line 3, a: expected a number with a decimal comma"):
        _column(path, "a", decimal=",")


def test_a_unit_error_names_both_units(tmp_path):
    for text in ("t,a [cm]\n0,1\n", "t,a [cm]\ns,cm\n0,1\n"):
        (tmp_path / "t.csv").write_text(text)
        table = read_table(tmp_path / "t.csv", TableLayout(data=text.count("\n")))
        with pytest.raises(InputError, match=r"column 'a \[cm\]': expected mm; the header states cm"):
            table.column("a [cm]", MM, "displacement")


CLOCKS = {
    "a comma": (["14:03:21,250", "14:03:21,260"], [50601.25, 50601.26]),
    "whole seconds": (["9:59:59", "10:00:00"], [35999.0, 36000.0]),
    "midnight": (["23:59:59.99", "00:00:00.01", "00:00:00.03"], [86399.99, 86400.01, 86400.03]),
    "a fall that is no midnight": (["14:03:21.25", "14:03:20.25"], [50601.25, 50600.25]),
    "a date": (["2026-03-04 14:03:21.250", "2026-03-04T14:03:21.252Z"], [50601.25, 50601.252]),
    "a date in German": (["04.03.2026 23:59:59,99", "05.03.2026 00:00:00,00"], [86399.99, 86400.0]),
    "an American clock": (["3/4/2026 11:59:59.5 PM", "3/5/2026 12:00:00.5 am"], [86399.5, 86400.5]),
    "a date that changes at noon": (["04.03. 12:00:00", "05.03. 12:00:01"], [43200.0, 129601.0]),
    "a date that stays": (["2026-03-04 23:59:59", "2026-03-04 00:00:01"], [86399.0, 1.0]),
}


@pytest.mark.parametrize("what", CLOCKS)
def test_clocks_of_the_day_are_seconds(what, tmp_path):
    cells, seconds = CLOCKS[what]
    (tmp_path / "t.csv").write_text("\n".join(["t;a", *(f"{cell};1" for cell in cells)]))
    assert read_table(tmp_path / "t.csv", TableLayout()).times("t").tolist() == seconds
    # a map of tests with clocks and with milliseconds names the unit of the latter
    assert read_table(tmp_path / "t.csv", TableLayout()).times("t", Decimal("0.001")).tolist() == seconds
    (tmp_path / "t.csv").write_text("\n".join(f"{cell};1" for cell in cells))  # without names
    assert read_table(tmp_path / "t.csv", TableLayout()).times("1").tolist() == seconds


def test_clocks_of_a_workbook_are_seconds(tmp_path):
    start = datetime(2026, 3, 4, 23, 59, 59, 990_000)
    dated = [start + timedelta(milliseconds=5 * row) for row in range(4)]
    seconds = [86399.99, 86399.995, 86400.0, 86400.005]
    path = _book(tmp_path / "b.xlsx", one=[["t"], *([cell] for cell in dated)])
    assert read_table(path, TableLayout()).times("t").tolist() == seconds
    path = _book(tmp_path / "b.xlsx", one=[["t"], *([cell.time()] for cell in dated)])
    assert read_table(path, TableLayout()).times("t").tolist() == seconds
    lasted = [timedelta(seconds=one) for one in seconds]
    path = _book(tmp_path / "b.xlsx", one=[["t"], *([cell] for cell in lasted)])
    assert read_table(path, TableLayout()).times("t").tolist() == seconds
    path = _book(tmp_path / "b.xlsx", one=[["t", "a"], [time(14, 3, 21), 1], [None, 1]])
    with pytest.raises(
        InputError, match=r"line 3, t: expected a clock of the day such as 14:03:21\.250, not ''"
    ):
        read_table(path, TableLayout()).times("t")


def test_a_time_beyond_all_numbers_is_refused(tmp_path):
    (tmp_path / "t.csv").write_text("t,a\n0,1\n1e400,1\n")
    with pytest.raises(InputError, match="column 't': expected numbers of usual size"):
        read_table(tmp_path / "t.csv", TableLayout()).times("t")


def test_minutes_and_seconds_alone_are_no_clock(tmp_path):
    (tmp_path / "t.csv").write_text("t;a\n03:21.25;1\n")
    with pytest.raises(
        InputError, match=r"expected a number with a decimal point, or nothing, not '03:21\.25'"
    ):
        read_table(tmp_path / "t.csv", TableLayout()).times("t")
