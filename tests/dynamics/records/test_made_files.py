"""Made files in every format and layout: the command gives what the formula and the printed digits say, or refuses."""

import csv
import io
import os
from pathlib import Path
from typing import NamedTuple

import numpy as np
import openpyxl
import pytest
from record_files import COUNT, KNET_SCALE, STEP, at2, cosmos, csmip, dyna, knet, series, smc

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[4] / "shared")) / "cases"
G = 9.80665
CM = series()  # cm/s2, three decimals
GS = np.round(CM / 980.665, 7)
COUNTS = np.round(CM / KNET_SCALE).astype(int) - 18000
TIMES = [f"{STEP * row:.2f}" for row in range(COUNT)]


class Made(NamedTuple):
    """A file and what it states."""

    name: str
    content: str | bytes
    values: np.ndarray  # m/s2
    options: tuple = ()
    column: str = "acceleration_x"


def printed(values, decimals):
    """Numbers that the digits of a print say."""
    return np.array([float(f"{value:.{decimals}f}") for value in values])


def fortran(value, digits=7):
    """A number as Fortran's D format prints it, without a zero before the point."""
    mantissa, exponent = f"{value:.{digits - 1}E}".split("E")
    sign, figures = ("-" if value < 0 else ""), mantissa.replace(".", "").replace("-", "")
    return f"{sign}.{figures}D{int(exponent) + 1 if value else 0:+03d}".rjust(digits + 6)


def scientific(values, digits):
    """Values as an E format of so many digits behind the point keeps them."""
    return np.array([float(f"{value:.{digits}E}") for value in values])


def unit_line(units):
    """An AT2 in a unit of cm/s2."""
    return at2(CM, units=units)


def table(separator=",", decimal=".", names=("t", "a"), values=CM, digits=3, times=TIMES, end=""):
    """Times and values as a spreadsheet writes them."""
    cells = [(time, f"{value:.{digits}f}") for time, value in zip(times, values, strict=True)]
    lines = [separator.join(names), *(separator.join(row).replace(".", decimal) for row in cells)]
    return "".join(f"{line}{end}\n" for line in lines)


def workbook(cells):
    """Bytes of a workbook."""
    book, content = openpyxl.Workbook(), io.BytesIO()
    for row in cells:
        book.active.append(row)
    book.save(content)
    return content.getvalue()


TABLE = ("--time", "t", "--column", "x=a", "--unit")
LATIN = dyna(CM, STATION_NAME="Cefalù, Peloritani").encode("latin-1")

MADE = [
    Made("a.at2", at2(GS), G * scientific(GS, 7)),
    *(
        Made("a.at2", at2(GS, units=units), G * scientific(GS, 7))
        for units in ("G. FILTER POINTS: HP=0.2 Hz LP=33.0 Hz", "G,", "G;", "(G)", "G'S", "g", "[g]", "G  (made up)")
    ),
    *(
        Made("a.at2", unit_line(units).encode("latin-1"), 0.01 * scientific(CM, 7))
        for units in (
            "CM/S/S.", "CM/SEC**2", "cm/s²", "cm/s/s", "Gal", "gal.", "CM/SEC/SEC", "CM / SEC / SEC", "cm/s**2",
            "CM/S2", "cm s^-2", "(CM/SEC2)", "cm/sec^2, corrected",
        )
    ),
    Made("a.at2", at2(CM * 10.0, units="MM/S2"), 0.01 * scientific(CM * 10.0, 7) / 10.0),
    Made("a.at2", at2(CM * 0.01, units="m/s**2"), scientific(CM * 0.01, 7)),
    Made("a.at2", at2(GS, sizes=f"{COUNT}   0.0100   NPTS, DT"), G * scientific(GS, 7)),
    Made("a.at2", at2(GS, sizes=f"DT= .0100 SEC, NPTS= {COUNT}"), G * scientific(GS, 7)),
    *(Made("a.at2", at2(GS, sizes=f"NPTS={COUNT}, DT= .01 SEC, {more}"), G * scientific(GS, 7)) for more in (
        f"PGA= {np.abs(GS).max():.4f}", f"PEAK: {np.abs(CM).max():.2f} CM/S2", "RATE= 100 HZ", "100 SPS", "LP= 33 HZ")),
    Made("a.at2", at2(GS, sizes=f"NPTS={COUNT},DT=0.01"), G * scientific(GS, 7)),
    Made("a.at2", at2(GS, cells=[fortran(value) for value in GS]), G * scientific(GS, 6)),
    Made("a.at2", at2(GS, cells=[f" {value}" for value in GS.tolist()]), G * GS),  # zeros left out
    Made("a.txt", at2(GS).replace("\n", "\r\n"), G * scientific(GS, 7)),
    Made("a.AT2", "\ufeff" + at2(GS).strip(), G * scientific(GS, 7)),
    Made("a.at2", at2(GS).replace("MADE UP", "MÀDE UP").encode("latin-1"), G * scientific(GS, 7)),
    Made("a.at2", at2(GS).replace("MADE UP", "MADE\fUP\x85") + "\x1a", G * scientific(GS, 7)),
    Made("a.asc", dyna(CM), 0.01 * CM),
    Made("a.asc", dyna(CM / 100.0, **{"UNITS": "m/s^2", "PGA_CM/S^2": f"{CM.min():.6f}"}), printed(CM / 100.0, 6)),
    Made("a.asc", dyna(CM, **{"PGA_CM/S^2": "", "TIME_PGA_S": "", "DURATION_S": ""}), 0.01 * CM),
    Made("a.asc", dyna(CM, DURATION_S=f"{STEP * (COUNT - 1):.3f}"), 0.01 * CM),
    Made("a.asc", LATIN, 0.01 * CM),
    Made("a.v2c", cosmos(CM), 0.01 * CM),
    Made("a.v2", cosmos(CM, entries={62: -999.0}), 0.01 * CM),
    Made("a.v2", cosmos(CM, entries={63: STEP * (COUNT - 1)}), 0.01 * CM),
    Made("a.v2", cosmos(CM, entries={64: -999.0, 65: -999.0}), 0.01 * CM),
    Made("a.v2", cosmos(CM, units="cm/sec2(04)", layout="8F10.5"), 0.01 * CM),
    Made("a.v2", cosmos(CM, layout="1F15.6"), 0.01 * CM),
    Made("a.v2", cosmos(CM, layout="10F7.3"), 0.01 * CM),  # columns that touch
    Made("a.v2", cosmos(GS, units="g (2)", layout="5F11.7", of=980.665), G * GS),
    Made("a.v2", cosmos(CM, channels=3), 0.01 * printed(1.5 * CM, 3), ("--column", "x=2")),
    Made("a.v2", cosmos(CM, channels=3), 0.02 * CM, ("--column", "z=270 deg"), "acceleration_z"),
    Made("a.v2", csmip(CM), 0.01 * CM),
    Made(
        "a.v2",
        csmip(CM, units=".  (UNITS: CM/SEC/SEC)", decimals=3).upper(),
        0.01 * CM,
    ),
    Made("a.v2", csmip(CM, units=", in cm/sec2. (10f7.3)", width=7, columns=10, decimals=3), 0.01 * CM),
    Made("a.v2", csmip(CM, channels=3), 0.02 * CM, ("--column", "x=270 Deg")),
    Made("a.v2", csmip(CM, step="0.01", interval=".0100", reals={60: 0.0, 61: 0.0, 65: 0.0, 66: 0.0}), 0.01 * CM),
    Made("a.ew", knet(COUNTS), 0.01 * KNET_SCALE * COUNTS),
    Made("a.ew", "\n" + knet(COUNTS), 0.01 * KNET_SCALE * COUNTS),
    Made("a.txt", "\n" + at2(GS), G * scientific(GS, 7)),
    Made("a.at2", at2(GS).replace("PEER NGA STRONG MOTION DATABASE RECORD", ""), G * scientific(GS, 7)),
    Made("a.ew2", knet(COUNTS, direction="5"), 0.01 * KNET_SCALE * COUNTS),
    Made("a.ns", knet(COUNTS, **{"Memo.": "地震"}).encode("shift-jis"), 0.01 * KNET_SCALE * COUNTS),
    Made("a.smc", smc(CM), 0.01 * scientific(CM, 4)),
    Made("a.smc", smc(CM, precise=True), 0.01 * scientific(CM, 7)),
    Made("a.smc", smc(CM, kind="1 UNCORRECTED ACCELEROGRAM"), 0.01 * scientific(CM, 4)),
    Made("t.csv", table(), 0.01 * CM, (*TABLE, "cm/s²")),
    Made("t.csv", table(";", ","), 0.001 * CM, (*TABLE, "mm/s2", "--decimal", ",")),
    Made("t.csv", table("\t", ",").encode("utf-16"), 0.01 * CM, (*TABLE, "gal", "--decimal", ",")),
    Made("t.csv", table("|", names=("t [s]", "Süd (cm/s²)")).encode("cp1252"), 0.01 * CM,
         ("--time", "t [s]", "--column", "x=Süd (cm/s²)", "--unit", "CM/SEC**2")),
    Made("t.csv", table(end=","), 0.01 * CM, (*TABLE, "Gal")),
    Made("t.csv", table(" ", names=("t", "a")), 0.01 * CM, (*TABLE, "cm/s/s")),
    Made("t.csv", table(times=[f"{10 * row}" for row in range(COUNT)], names=("t_ms", "a")), 0.01 * CM,
         ("--time", "t_ms", "--time-unit", "ms", "--column", "x=a", "--unit", "cm/s2")),
    Made("t.csv", "logger\n" + table(";").replace("t;a\n", "t;a\ns;cm/s2\n"), 0.01 * CM,
         (*TABLE, "cm/s2", "--header", "2", "--data", "4")),
    Made("t.txt", "".join(f"{time} {fortran(value)}\n" for time, value in zip(TIMES, CM, strict=True)),
         0.01 * scientific(CM, 6), ("--time", "1", "--column", "y=2", "--unit", "cm/s2"), "acceleration_y"),
    Made("t.xlsx", workbook([["t", "a"], *([STEP * row, value] for row, value in enumerate(CM.tolist()))]), 0.01 * CM,
         (*TABLE, "cm/s2", "--decimal", ",")),
    Made("t.xlsx", workbook([["t", "a"], *([time, f"{value:.3f}".replace(".", ",")] for time, value in
                                           zip((STEP * np.arange(COUNT)).tolist(), CM, strict=True))]), 0.01 * CM,
         (*TABLE, "cm/s2", "--decimal", ",")),
    Made("m.csv", "time_s,acceleration_x\n" + "".join(f"{time},{value:.5f}\r\n" for time, value in
                                                      zip(TIMES, 0.01 * CM, strict=True)), 0.01 * CM),
]  # fmt: skip


def write(folder, name, content):
    """A file of text or bytes."""
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("made", MADE, ids=lambda made: made.name)
def test_a_made_file_gives_what_it_states(made, tmp_path):
    path = write(tmp_path, made.name, made.content)
    output = tmp_path / "converted.csv"
    assert (
        main(["convert-motion", str(path), *made.options, "--baseline", "none", "--output", str(output)]) == 0
    )
    with open(output, newline="") as file:
        read = list(csv.reader(file))
    assert read[0] == ["time_s", made.column]
    time, values = np.array(read[1:], dtype=float).T
    assert len(values) == COUNT
    np.testing.assert_allclose(np.diff(time), STEP, rtol=1e-9)
    place = np.argmax(np.abs(made.values))
    assert np.argmax(np.abs(values)) == place
    assert time[place] == pytest.approx(STEP * place, abs=1e-9)
    assert values[place] == pytest.approx(made.values[place], rel=1e-12)
    assert values[-1] == pytest.approx(made.values[-1], abs=1e-9)  # rebuilt from a cubic
    assert time[-1] == pytest.approx(STEP * (COUNT - 1), abs=1e-9)
    np.testing.assert_allclose(values, made.values, rtol=1e-12, atol=1e-9)


def test_there_are_many_made_files():
    assert len(MADE) >= 40


FREE = {"approx": 4, "entries": {63: -999.0, 64: -999.0, 65: -999.0}}
PEAK, AT = f"{0.01 * CM.min():.4g}"[:5], f"{STEP * np.argmin(CM):.3g}"
REFUSED = [
    ("a.asc", dyna(CM, DURATION_S="6.000"), ("DURATION_S", "5 s", "6 s")),
    ("a.asc", dyna(CM, SAMPLING_INTERVAL_S="0.005"), ("DURATION_S", "2.5 s", "5 s")),
    ("a.asc", dyna(CM, **{"PGA_CM/S^2": "-81.5"}), ("PGA_CM/S^2", "-0.815")),
    ("a.asc", dyna(CM, **{"PGA_CM/S^2": "79.963"}).replace("cm/s^2", "m/s^2"), ("PGA_CM/S^2", "0.799")),
    ("a.asc", dyna(CM, **{"TIME_PGA_S": "3.00"}), ("TIME_PGA_S", AT, "3 s")),
    ("a.asc", dyna(CM, NDATA="501"), ("NDATA", "501", "500")),
    ("a.asc", dyna(CM).replace("STREAM: HNE", "UNITS: m/s^2"), ("UNITS", "once")),
    ("a.asc", dyna(CM)[:-4], ("line 564", "cut short")),
    ("a.at2", at2(GS).rstrip()[:-1], ("cut short",)),
    ("a.asc", dyna(CM).replace(f"{CM[9]:.6f}", f"{CM[9]:.2f}", 1), ("line 74", "cut short")),
    ("a.at2", at2(GS).replace(f"{GS[7]:15.7E}", f"{GS[7]:.7E}"[:-1].rjust(15)), ("line 6", "cut short")),
    ("a.v2", cosmos(CM, **FREE).replace(f"{CM[3]:9.3f}", f"{CM[3]:9.1f}", 1), ("line 49", "cut short")),
    ("a.at2", at2(GS, sizes=f"NPTS= {COUNT - 5}, DT= .01 SEC"), ("NPTS", "495", "500")),
    *(("a.at2", at2(GS, sizes=f"NPTS= {COUNT}, DT= .01 SEC, {more}"), words) for more, words in (
        ("PGA= 0.9", ("PGA", "found 8.82")), ("PEAK: 90 cm/s2", ("PGA", "found 0.9 m/s2")),
        ("RATE= 200 HZ", ("FS", "0.005")), ("200 SPS", ("FS", "0.005")))),
    ("a.at2", at2(GS).replace(f"{GS[7]:15.7E}", "  -0.9990000E+03"), ("looks like a code for none", "line 6")),
    ("a.at2", at2(GS, units="CM/S"), ("line 3", "'CM/S'")),
    ("a.v2", cosmos(CM, entries={62: 5.0}), ("entry 63", "2.5 s", "5 s")),
    ("a.v2", cosmos(CM, entries={62: 0.01}), ("entry 63", "0.005 s", "5 s")),
    ("a.v2", cosmos(CM, entries={63: 10.0}), ("entry 63", "5 s", "10 s")),
    ("a.v2", cosmos(CM, entries={64: 81.0}), ("entry 64", "0.81 m/s2")),
    ("a.v2", cosmos(-CM, entries={64: CM.min()}), ("entry 64", "0.799")),
    ("a.v2", cosmos(CM, entries={65: 3.5}), ("entry 65", AT, "3.5 s")),
    ("a.v2", cosmos(CM, approx=12), ("line 48", "5 s", "12 s")),
    ("a.v2", cosmos(CM, count=400), ("line 48", "more")),
    ("a.v2", cosmos(CM - 200.0, count=400, layout="10F8.3", **FREE), ("line 48", "more")),  # they touch, by a sign
    ("a.v2", cosmos(CM + 200.0, count=400, layout="10F7.3", **FREE), ("line 48", "more")),  # and without any
    ("a.v2", csmip(CM - 200.0, units=", in cm/sec2. (10f8.3)", width=8, columns=10, decimals=3, count=400, points=400),
     ("line 46", "more")),
    ("a.v2", cosmos(CM, text="Max = 90.0 cm/sec2 at 2.530 sec"), ("line 12", "0.9 m/s2")),
    ("a.v2", cosmos(CM, channels=2), ("1: 90 Deg; 2: 180 Deg", "--column x=NUMBER")),
    ("a.v2", csmip(CM, step="0.020"), ("line 17", "0.01 s", "0.02 s")),
    ("a.v2", csmip(CM, interval="0.005"), ("line 17", "0.01 s", "0.005 s")),
    ("a.v2", csmip(CM, points=499), ("line 16", "500", "499")),
    ("a.v2", csmip(CM, count=480), ("480",)),
    ("a.v2", csmip(CM, peak="-90.000"), ("line 18", "-0.9 m/s2")),
    ("a.v2", csmip(CM, time="4.000"), ("line 18", AT, "4 s")),
    ("a.v2", csmip(CM, reals={60: 6.0}), ("entry 60", "5 s", "6 s")),
    ("a.v2", csmip(CM, reals={61: 0.02}), ("entry 61", "0.01 s", "0.02 s")),
    ("a.v2", csmip(CM, reals={65: 1.0}), ("entry 65", AT, "1 s")),
    ("a.v2", csmip(CM, reals={66: 100.0}), ("entry 66", "1 m/s2")),
    ("a.v2", csmip(CM, channels=2), ("1: 90 Deg; 2: 180 Deg", "--column x=NUMBER")),
    ("a.ew", knet(COUNTS, **{"Sampling Freq(Hz)": "200Hz"}), ("1000", "500")),
    ("a.ew", knet(COUNTS, **{"Duration Time(s)": "6"}), ("600", "500")),
    ("a.ew", knet(COUNTS, **{"Max. Acc. (gal)": "99.000"}), ("Max. Acc. (gal)", "0.99 m/s2")),
    ("a.ew", knet(COUNTS, **{"Scale Factor": "4000(gal)/8388608"}), ("Max. Acc. (gal)",)),
    ("a.ew", knet(COUNTS, **{"Scale Factor": "2000/8388608"}), ("Scale Factor",)),
    ("a.smc", smc(CM, real={2: 200.0}), ("real number 29",)),
    ("a.smc", smc(CM, real={30: 70.0}), ("real number 30", "0.7 m/s2")),
    ("a.smc", smc(CM, real={31: 1.0}), ("real number 31", "1 s")),
    ("a.smc", smc(CM, peak="100.0"), ("line 7", "1 m/s2")),
    ("a.smc", smc(CM, whole={17: 480}), ("480", "more")),
    ("a.smc", smc(-1e2 - abs(CM), whole={17: 480}), ("480", "more")),
    ("a.smc", smc(CM, kind="3 VELOCITY"), ("line 1", "3 VELOCITY")),
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "words"), REFUSED)
def test_a_header_that_contradicts_its_values_is_refused(name, content, words, tmp_path, capsys):
    path = write(tmp_path, name, content)
    assert main(["convert-motion", str(path), "--baseline", "none", "--output", str(tmp_path / "o.csv")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert [word for word in words if word not in said] == [], said
    assert not (tmp_path / "o.csv").exists()


TABLES = [
    ("t.csv", "t;a\n0;998\n0,01;1.012\n", (*TABLE, "mm/s2", "--decimal", ","), "line 3, a: expected a number"),
    ("t.csv", "t;a\n0;998\n0,01;1.012,5\n", (*TABLE, "mm/s2", "--decimal", ","), "line 3, a: expected a number"),
    ("t.csv", "t;a\n0;998\n0.01;1,012\n", (*TABLE, "mm/s2"), "line 3, a: expected a number"),
    ("t.csv", "t;a\n0;998\n0.01;1,012.5\n", (*TABLE, "mm/s2"), "line 3, a: expected a number"),
    ("t.csv", "t;a\n0;1_0\n0.01;1\n", (*TABLE, "mm/s2"), "line 2, a: expected a number"),
    ("t.csv", "t,a\n0,01,5\n0,02,6\n", (*TABLE, "mm/s2"), "line 2: expected at most 2 cells as in line 1, found 3"),
    ("t.txt", "t a b\n0 1 2\n0.1 3\n0.2 1 2\n", (*TABLE, "mm/s2"), "line 3: expected 3 cells"),
    ("t.csv", table(names=("t", "a [g]")), ("--time", "t", "--column", "x=a [g]", "--unit", "m/s2"),
     "column 'a [g]': expected m/s2; the header states g"),
    ("t.csv", table(names=("t_ms", "a")), ("--time", "t_ms", "--column", "x=a", "--unit", "m/s2"),
     "column 't_ms': expected s; the header states ms"),
    ("t.csv", table().replace("t,a\n", "t,a\nms,g\n"), (*TABLE, "g", "--data", "3"),
     "column 't': expected s; the header states ms"),
    ("t.csv", table().replace(f",{CM[3]:.3f}\n", ",-999\n"), (*TABLE, "g"), "'-999' looks like a code"),
    ("t.csv", table().replace(f",{CM[3]:.3f}\n", ",9999\n"), (*TABLE, "g"), "'9999' looks like a code"),
    ("t.csv", table().replace(f",{CM[3]:.3f}\n", ",nan\n"), (*TABLE, "g"), "line 5, a: expected a finite number"),
    ("t.csv", table(times=[*TIMES[:9], *TIMES[8:-1]]), (*TABLE, "g"), "line 11, t: expected times that increase"),
    ("t.csv", table(times=[*TIMES[:9], *(f"{float(at) + 3.0:.2f}" for at in TIMES[9:])]), (*TABLE, "g"),
     "line 11, t: expected rows 0.01 s apart as elsewhere; 3.01 s after 0.08 s have none, 1 such gap in all"),
    *(("t.csv", table(names=("t", name)), ("--time", "t", "--column", f"x={name}", "--unit", "cm/s2"),
       f"column '{name}': expected cm/s2; the header states {unit}")
      for unit, names in (("g", ("acc_g", "acc/g", "acc g", "acc - g", "acc=g", "a{g}", "a<g>")), ("cm/s", ("v cm/s",)),
                          ("m/s2", ("acc_m/s2", "acc_m_s2", "acc_mps2", "acc m/s/s")), ("mm", ("EW_mm",)))
      for name in names),
    *(("t.csv", table(names=(name, "a")), ("--time", name, "--time-unit", "ms", "--column", "x=a", "--unit", "g"),
       f"column '{name}': expected ms; the header states {'min' if 'min' in name else 's'}")
      for name in ("t_s", "time_s", "Zeit/s", "t s", "time - min")),
    ("t.csv", table(), ("--time", "t"), "--unit: expected for a table"),
    ("t.csv", table(), ("--unit", "g"), "--column: expected for a table"),
    ("m.csv", "time_s,acceleration_x\n" + "".join(f"{row / 100 + 3 * (row > 99)},{row % 7}\n" for row in range(200)),
     (),
     "line 102, time_s: expected rows 0.01 s apart as elsewhere; 3.01 s after 0.99 s have none"),
    ("m.csv", "time_s,acceleration_x\n0,1\n1,-9999\n2,1\n", (), "line 3, acceleration_x: expected a value; -9999"),
    ("m.csv", "time_s,acceleration_x\n0,1_0\n1,1\n", (), "line 2, acceleration_x: expected a finite number"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "options", "words"), TABLES)
def test_a_table_that_could_be_read_in_two_ways_is_refused(name, content, options, words, tmp_path, capsys):
    path = write(tmp_path, name, content)
    assert main(["convert-motion", str(path), *options, "--output", str(tmp_path / "o.csv")]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1
    assert not (tmp_path / "o.csv").exists()


def test_a_sparse_table_is_no_table_with_a_gap(tmp_path):
    path = write(tmp_path, "m.csv", "time_s,displacement_x\n0,0\n1,0.1\n2,0.1\n30,0\n")
    assert load_motion(path).duration == 30.0


@pytest.mark.parametrize("scale", ["0", "nan", "inf", "-0.0"])
def test_a_scale_that_leaves_no_motion_is_refused(scale, tmp_path, capsys):
    call = ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "nscd-rigid"]
    assert main([*call, f"--scale={scale}", "--output", str(tmp_path / "run.nc")]) == 2
    assert "scale: expected a finite number other than 0" in capsys.readouterr().err


def test_a_record_says_what_was_checked_and_assumed(tmp_path):
    attributes = load_motion(write(tmp_path, "a.v2", cosmos(CM, entries={62: -999.0}))).attributes
    assert attributes["checked"] == "number of values, length, peak, time of the peak"
    assert attributes["assumed"] == (
        "a component along x; a time step of 0.01 s, the length over the number of values"
    )
    attributes = load_motion(write(tmp_path, "b.v2", csmip(CM, channels=2)), channels={"y": "2"}).attributes
    assert attributes["assumed"] == "nothing"
    assert attributes["channels"] == "y: 180 Deg"


def test_a_channel_is_of_one_axis(tmp_path):
    path = write(tmp_path, "b.v2", csmip(CM, channels=2))
    with pytest.raises(InputError, match="channels: y=180 deg: expected every channel for one axis"):
        load_motion(path, channels={"x": "2", "y": "180 deg"})


@pytest.mark.parametrize("name", ["alkion", "m.csv"])
def test_channels_are_of_records_alone(name, tmp_path, capsys):
    if name == "m.csv":
        name = str(write(tmp_path, name, "time_s,acceleration_x\n0,0\n1,1\n"))
    assert main(["convert-motion", name, "--column", "y=1", "--output", str(tmp_path / "o.csv")]) == 2
    assert "--column: expected for a record, or with --unit for a table" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("case", "length", "peak", "at"),
    [
        ("cosmos-v2-interval/record.v2", 9.99, 1.47066, 3.84),
        ("at2-unit-full-stop/record.AT2", 4.02, 2.39724, None),
    ],
)
def test_records_of_shared_cases(case, length, peak, at, tmp_path):
    if not (CASES / case).exists():
        pytest.skip(f"no case in {CASES} (set BLOCKSHAKE_SHARED)")
    output = tmp_path / "m.csv"
    assert main(["convert-motion", str(CASES / case), "--baseline", "none", "--output", str(output)]) == 0
    time, values = np.loadtxt(output, delimiter=",", skiprows=1).T
    place = int(np.argmax(np.abs(values)))
    assert time[-1] == pytest.approx(length, abs=1e-9)
    assert abs(values[place]) == pytest.approx(peak, abs=1e-5)
    assert at is None or time[place] == pytest.approx(at, abs=1e-9)


def test_the_table_of_a_shared_case(tmp_path, capsys):
    path = CASES / "thousands-point" / "record.csv"
    if not path.exists():
        pytest.skip(f"no case in {CASES} (set BLOCKSHAKE_SHARED)")
    options = ["--unit", "mm/s2", "--decimal", ",", "--column", "x=acc"]
    assert main(["convert-motion", str(path), *options, "--output", str(tmp_path / "m.csv")]) == 2
    assert "record.csv: line 4, acc: expected a number with a decimal comma" in capsys.readouterr().err
