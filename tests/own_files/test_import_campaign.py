"""Spreadsheets of a laboratory become a campaign, to the written digit, or one clear line."""

import re
from decimal import Decimal

import numpy as np
import openpyxl
import pandas as pd
import pytest
import xarray as xr
import yaml
from scipy.spatial.transform import Rotation

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import PACKAGE
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.clocks import from_first_reading
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.simulation.simulate import simulate

SHIPPED = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-1"
TEST = "basso-tirreno-200"
LENGTH = 8.0  # s, in which the strongest shaking is
CHANNELS = ["slab-acc-x", "block-3-acc-x"]


@pytest.fixture(scope="module")
def virtual():
    """A virtual test, cut, its readings with the digits that a laboratory writes."""
    test = load_test(load_campaign(SHIPPED), TEST)
    test = test.sel(time=slice(0.0, LENGTH), time_acc=slice(0.0, LENGTH), channel=CHANNELS)
    written = {"marker_displacement": "{:.5f}", "accelerometer": "{:.3f}"}
    return xr.Dataset({
        name: test[name].copy(data=np.vectorize(lambda one, form=form: float(form.format(one)))(test[name]) + 0.0)
        for name, form in written.items()
    })  # fmt: skip


def _written(value, size, decimal):
    """Digits of a number in a unit of a size."""
    if np.isnan(value):
        return ""
    return f"{(Decimal(repr(float(value))) / Decimal(size)).normalize():f}".replace(".", decimal)


def _tables(test, decimal="."):
    """Rows of the markers' table (mm) and of the accelerometers' (cm/s2), as text, the names first."""
    names = [f"{marker}.{axis}" for marker in test["marker"].values for axis in "xyz"]
    moved = test["marker_displacement"].to_numpy().reshape(test.sizes["time"], -1)
    tables = []
    for time, columns, values, size in (
        ("time", names, moved, "0.001"),
        ("time_acc", CHANNELS, test["accelerometer"].to_numpy(), "0.01"),
    ):
        rows = [["Zeit", *columns]]
        for at, row in zip(test[time].values, values, strict=True):
            rows.append([_written(at, "1", decimal), *(_written(one, size, decimal) for one in row)])
        tables.append(rows)
    return tables


def _map(folder, test, markers, accelerometers, decimal):
    names = [f"{marker}.{axis}" for marker in test["marker"].values for axis in "xyz"]
    columns = "\n".join(f"  {name}: {name}" for name in [*names, *CHANNELS])
    (folder / "map.yaml").write_text(f"""
name: round-trip
structure: configuration-1
layout: {{decimal: "{decimal}"}}
time: Zeit
displacement_unit: mm
acceleration_unit: cm/s2
tests:
  - {{name: t1, file: "{markers}", accelerometers: "{accelerometers}", motion: basso-tirreno, scale: 2.0, role: fit}}
columns:
{columns}
""")
    return folder / "map.yaml"


def _equal_again(virtual, source, folder):
    assert main(["import-campaign", str(source), "--output", str(folder / "campaign")]) == 0
    campaign = load_campaign(folder / "campaign")
    again = read_test(campaign.folder / campaign.tests["t1"].file, load_structure(campaign.structure))
    virtual = from_first_reading(virtual)
    for name in ("marker_displacement", "accelerometer"):
        xr.testing.assert_identical(
            again[name].drop_attrs().rename(None), virtual[name].drop_attrs().rename(None)
        )


@pytest.mark.parametrize("zero", [0.0, 43200.0])
def test_a_german_csv_comes_back_to_the_digit(virtual, zero, tmp_path):
    """Also where its clock shows the time of day."""
    shown = virtual.assign_coords(time=virtual["time"] + zero, time_acc=virtual["time_acc"] + zero)
    for name, rows in zip(("m.csv", "a.csv"), _tables(shown, ","), strict=True):
        (tmp_path / name).write_text("\n".join(";".join(row) for row in rows), encoding="cp1252")
    _equal_again(virtual, _map(tmp_path, virtual, "m.csv", "a.csv", ","), tmp_path)


def test_a_logger_with_its_own_clock_is_refused_with_the_offset_that_the_slab_tells(
    virtual, tmp_path, capsys
):
    """The logger is 4321.6 s late; both are compared at 100 Hz, so the offset is known to half of 10 ms."""
    shown = virtual.assign_coords(time_acc=virtual["time_acc"] + 4321.6)
    for name, rows in zip(("m.csv", "a.csv"), _tables(shown, ","), strict=True):
        (tmp_path / name).write_text("\n".join(";".join(row) for row in rows), encoding="cp1252")
    source = _map(tmp_path, virtual, "m.csv", "a.csv", ",")
    asked = ["import-campaign", str(source), "--output", str(tmp_path / "campaign")]
    assert main(asked) == 2
    said = capsys.readouterr().err
    assert f"{source}: tests.t1.accelerometers_offset: " in said
    assert re.search(
        r"expected the clock of time, 0\.00\d+ to 7\.99\d+ s, not 4321\.6\d+ to 4329\.\d+ s; ", said
    )
    told = re.search(r"the slab's sensors agree with (-\d+\.\d{3}) s added to it\n", said)[1]
    assert float(told) == pytest.approx(-4321.6, abs=0.006)
    text = source.read_text()
    source.write_text(text.replace("role: fit", "role: fit, accelerometers_offset: -4321.6"))
    assert main(asked) == 0
    again = load_test(load_campaign(tmp_path / "campaign"), "t1")
    apart = [float(test["time_acc"][0] - test["time"][0]) for test in (again, virtual)]
    assert apart[0] == pytest.approx(apart[1], abs=1e-5)
    assert "the accelerometers' times" not in capsys.readouterr().out
    source.write_text(text.replace('accelerometers: "a.csv"', "accelerometers_offset: 1.0"))
    assert main(asked) == 2
    assert "accelerometers_offset: expected a file accelerometers with it" in capsys.readouterr().err


def test_a_workbook_comes_back_to_the_digit(virtual, tmp_path):
    book = openpyxl.Workbook()
    book.active.title = "Marker"
    for sheet, (names, *rows) in zip((book.active, book.create_sheet("Acc")), _tables(virtual), strict=True):
        sheet.append(names)
        for row in rows:
            sheet.append([float(cell) if cell else None for cell in row])
    book.save(tmp_path / "b.xlsx")
    _equal_again(virtual, _map(tmp_path, virtual, "b.xlsx#Marker", "b.xlsx#Acc", "."), tmp_path)


OPTIONS = [
    "--structure",
    "configuration-1",
    "--motion",
    "alkion",
    "--displacement-unit",
    "mm",
    "--decimal",
    ",",
]
COLUMNS = ["--time", "Zeit", "--column", "slab-face.x=Tisch", "--column", "block-1-face.x=Weg 1"]


def _transducers(path, change=lambda rows: rows):
    """A test of two displacement transducers along x, the second with an offset, and a column that nobody asks for."""
    rows = [[f"{step * 0.01:.2f}", "0,1", "57,3", "0,2"] for step in range(1300)]
    rows[-1][2] = "57,4"
    rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    text = ["Zeit;Tisch;Weg 1;frei", *(";".join(row) for row in change(rows))]
    path.write_text("\n".join(text))
    return str(path)


def test_transducers_along_x_leave_the_other_directions_missing(tmp_path, capsys):
    source, folder = _transducers(tmp_path / "v1.csv"), tmp_path / "campaign"
    assert (
        main(["import-campaign", source, *OPTIONS, *COLUMNS, "--rest", "0.5", "--output", str(folder)]) == 0
    )
    assert "not measured: y and z of all markers" in capsys.readouterr().out
    read = load_test(load_campaign(folder), "v1")["marker_displacement"]
    assert read.sel(axis=["y", "z"]).isnull().all()
    assert (abs(read.sel(axis="x")[:-1]) < 1e-12).all()
    # nothing of a folder with content is overwritten
    assert main(["import-campaign", source, *OPTIONS, *COLUMNS, "--output", str(folder)]) == 2
    assert "nothing is overwritten" in capsys.readouterr().err


def _set(row, column, cell):
    def change(rows):
        rows[row][column] = cell
        return rows

    return change


def _emptied(column, end=None):
    """A column without readings until a row, or at all."""
    return lambda rows: (
        [[*row[:column], "", *row[column + 1 :]] for row in rows[:end]] + rows[len(rows[:end]) :]
    )


def _without(first, last):
    return lambda rows: rows[:first] + rows[last:]


def _same(rows):
    return rows


BAD = {
    "a column that is not there": (
        _same, ["--column", "block-2-face.x=Weg 2"],
        "--column: block-2-face.x: ... v1.csv: column 'Weg 2': expected this column once; there are Zeit, Tisch",
    ),
    "an unknown unit": (_same, ["--displacement-unit", "inch"], "--displacement-unit: expected a unit of disp"),
    "no unit of accelerations": (_same, ["--column", "slab-acc-x=frei"], "--acceleration-unit: missing key"),
    "another unit in the header": (
        lambda rows: [["s", "mm", "cm", "mm"], *rows], ["--data", "3"],
        "--column: block-1-face.x: ... v1.csv: column 'Weg 1': expected mm; the header states cm",
    ),
    "a row of units": (_set(0, 2, "mm"), [], "--data: ... v1.csv: line 2, Weg 1: expected a number"),
    "a row of units without one of times": (
        lambda rows: [["", "mm", "mm", "mm"], *rows], [], "--data: ... v1.csv: line 2, Zeit: expected a time",
    ),
    "a decimal point": (_same, ["--decimal", "."], "--decimal: ... v1.csv: line 2, Zeit: expected a number with a dec"),
    "no such sign": (_same, ["--decimal", ";"], "--decimal: input should be '.' or ','"),
    "names too far down": (_same, ["--header", "1302"], "--header: ... v1.csv: expected names of columns in line 1302"),
    "a column that is empty": (
        _emptied(3), ["--column", "block-2-face.x=frei"],
        "--column: block-2-face.x: expected readings in 'frei' of ... v1.csv; all are missing",
    ),
    "a rest without readings": (
        _emptied(3, 100), ["--column", "block-2-face.x=frei"],
        "--rest: ... v1.csv: block-2-face.x: expected a reading in the first 0.5 s of rest",
    ),
    "times that go back": (_set(50, 0, "0,4"), [], "v1.csv: line 52, Zeit: expected times that increase; 0.4 s"),
    "no time": (_set(50, 0, ""), [], "v1.csv: line 52, Zeit: expected a time"),
    "text among numbers": (_set(9, 2, "over"), [], "v1.csv: line 11, Weg 1: expected a number with a decimal comma"),
    "a point for thousands": (_set(9, 2, "1.012"), [], "line 11, Weg 1: expected a number with a decimal comma"),
    "a code for none": (_set(9, 2, "-9999"), [], "line 11, Weg 1: expected a reading; '-9999' looks like a code"),
    "a cell too many": (_set(9, 2, "57;3"), [], "v1.csv: line 11: expected at most 4 cells as in line 1, found 5"),
    "a gap of the clock": (
        _without(200, 230), [],
        "--fill-gaps: ... v1.csv: line 202, Zeit: expected an even clock; 0.31 s after 1.99 s",
    ),
    "a clock in another unit": (_same, ["--time-unit", "ms"], "--time: ... v1.csv: time: expected seconds, with 20"),
    "an unknown marker": (
        _same, ["--column", "mystery.x=frei"],
        "--column: mystery.x: ... v1.csv: mystery: expected markers of the structure",
    ),
    "no axis": (_same, ["--column", "block-2-face=frei"], "--column: block-2-face: expected MARKER.x"),
    "no rest taken off": (
        _same, ["--rest", "0"],
        "--column: block-1-face.x: ... v1.csv: block-1-face.x: expected displacements since the first",
    ),
    "an empty file": (lambda rows: [], [], "--header: ... v1.csv: expected rows of numbers below the names"),
    "no separator": (_same, ["--separator", "::"], "--separator: ... v1.csv: expected one character"),
    "a column mapped twice": (
        _same, ["--column", "block-2-face.x=Tisch"],
        "--column: block-2-face.x: expected a column of its own; 'Tisch' is slab-face.x",
    ),
    "times as readings": (
        _same, ["--column", "block-2-face.x=Zeit"],
        "--column: block-2-face.x: expected a column of its own; 'Zeit' is time",
    ),
    "an unknown role": (_same, ["--role", "test"], "--role: input should be 'fit'"),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD)
def test_faults_get_one_line_and_leave_nothing(what, tmp_path, capsys):
    change, options, message = BAD[what]
    folder = tmp_path / "campaigns" / "mine"
    source = _transducers(tmp_path / "v1.csv", change)
    usual = [*OPTIONS, "--rest", "0.5"]
    pairs = zip(usual[::2], usual[1::2], strict=True)
    usual = [word for pair in pairs if pair[0] not in options for word in pair]
    assert main(["import-campaign", source, *usual, *COLUMNS, *options, "--output", str(folder)]) == 2
    said = capsys.readouterr().err
    assert all(part in said for part in message.split(" ... ")), said
    assert said.count("\n") == 1
    assert list(tmp_path.rglob("*.nc")) == []
    assert not folder.exists()


def test_rows_that_the_clock_lacks_become_gaps(tmp_path):
    source, folder = _transducers(tmp_path / "v1.csv", _without(200, 230)), tmp_path / "campaign"
    asked = [*OPTIONS, *COLUMNS, "--rest", "0.5", "--fill-gaps"]
    assert main(["import-campaign", source, *asked, "--output", str(folder)]) == 0
    read = load_test(load_campaign(folder), "v1")["marker_displacement"].sel(axis="x")
    np.testing.assert_allclose(read["time"], 0.01 * np.arange(1300), atol=1e-12)
    assert read.isnull().all("marker").values.nonzero()[0].tolist() == list(range(200, 230))


def _ramp(rows):
    """The block moves by 20 mm/s from 2 s on; one reading at 0.2 s is off by 30 mm, as a knock of the wire makes it."""
    for step in range(len(rows)):
        rows[step][2] = f"{57.3 + max(0.0, 0.2 * (step - 200)) + 30.0 * (step == 20):.1f}".replace(".", ",")
    return rows


def test_a_rest_in_which_a_sensor_moves_is_refused_with_the_time_of_the_motion(tmp_path, capsys):
    """The ramp is 3 x 0.1 mm, thrice the stated noise, at 2.015 s; the next reading is at 2.02 s."""
    source = _transducers(tmp_path / "v1.csv", _ramp)
    asked = [*OPTIONS, *COLUMNS, "--output", str(tmp_path / "c")]
    assert main(["import-campaign", source, *asked, "--rest", "5"]) == 2
    said = capsys.readouterr().err
    assert "--rest: " in said
    assert said.count("\n") == 1
    assert said.endswith(
        "v1.csv: block-1-face.x: expected rest in the first 5 s, of which it rests for 2.02 s: "
        "it moves from 2.02 s on\n"
    )
    assert not (tmp_path / "c").exists()
    assert main(["import-campaign", source, *asked, "--rest", "2"]) == 0
    read = load_test(load_campaign(tmp_path / "c"), "v1")["marker_displacement"]
    off = 0.03 / 201  # m, of the mean of 201 readings, by the knock
    end = read.sel(marker="block-1-face", axis="x").values[-1]
    assert end == pytest.approx(0.2e-3 * 1099 - off, abs=1e-9)


def test_a_map_may_turn_a_transducer_round(tmp_path, capsys):
    _transducers(tmp_path / "v1.csv", _set(700, 2, "58,3"))
    (tmp_path / "map.yaml").write_text("""
name: turned
structure: configuration-1
layout: {decimal: ","}
time: Zeit
displacement_unit: mm
rest: 0.5
columns:
  slab-face.x: Tisch
  block-1-face.x: {column: Weg 1, reversed: true}
tests: [{name: t 1, file: v1.csv, motion: alkion, scale: 1.0, role: fit}]
""")
    assert main(["import-campaign", str(tmp_path / "map.yaml"), "--output", str(tmp_path / "c")]) == 0
    read = load_test(load_campaign(tmp_path / "c"), "t 1")["marker_displacement"]
    assert read.sel(marker="block-1-face", axis="x").min() == pytest.approx(-1e-3, abs=1e-12)
    for option, *value in (["--rest", "1"], ["--column", "slab-face.x=Tisch"], ["--fill-gaps"]):
        call = [
            "import-campaign",
            str(tmp_path / "map.yaml"),
            option,
            *value,
            "--output",
            str(tmp_path / "d"),
        ]
        assert main(call) == 2
        assert f"{option}: {tmp_path / 'map.yaml'}: expected the map alone" in capsys.readouterr().err


MAP = """
name: several
structure: configuration-1
layout: {decimal: ","}
time: Zeit
displacement_unit: mm
rest: 0.5
columns: {slab-face.x: Tisch, block-1-face.x: Weg 1}
tests:
  - {name: t1, file: v1.csv, motion: alkion, scale: 1.0, role: fit}
  - {name: t2, file: v2.csv, motion: alkion, scale: 1.0, role: fit}
"""


def _mapped(folder, change, text=MAP):
    """Exit code of the import of two tests, the second one changed."""
    _transducers(folder / "v1.csv")
    _transducers(folder / "v2.csv", change)
    (folder / "map.yaml").write_text(text)
    return main(["import-campaign", str(folder / "map.yaml"), "--output", str(folder / "c")])


def test_a_column_that_is_empty_in_one_test_is_a_gap(tmp_path, capsys):
    assert _mapped(tmp_path, _emptied(2)) == 0
    assert "  t2: no readings of block-1-face, which other tests have" in capsys.readouterr().out
    campaign = load_campaign(tmp_path / "c")
    assert load_test(campaign, "t2")["marker"].values.tolist() == ["slab-face"]
    assert load_test(campaign, "t1")["marker"].values.tolist() == ["slab-face", "block-1-face"]


@pytest.mark.parametrize(("cell", "said"), [("10240", "10.24 m"), ("-999", "-0.999 m")])
@pytest.mark.parametrize("rest", ["rest: 0.5\n", ""])
def test_a_dead_channel_is_named_with_its_value(cell, said, rest, tmp_path, capsys):
    def stuck(rows):
        return [[time, "0,1", cell, free] for time, _, _, free in rows]

    moved = MAP.replace("rest: 0.5\n", rest).replace("Weg 1", "{column: Weg 1, reversed: false}")
    _transducers(tmp_path / "v2.csv", stuck)
    text = moved.replace("  - {name: t1, file: v1.csv, motion: alkion, scale: 1.0, role: fit}\n", "")
    assert _mapped(tmp_path, stuck, text) == 0
    assert f"t2: {said} throughout, taken as gaps: block-1-face.x" in capsys.readouterr().out
    assert load_test(load_campaign(tmp_path / "c"), "t2")["marker"].values.tolist() == ["slab-face"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (
            "Weg 1",
            "Weg 2",
            "map.yaml: columns.block-1-face.x: ... v1.csv: column 'Weg 2': expected this column once",
        ),
        ("time: Zeit", "time: t", "map.yaml: time: ... v1.csv: column 't': expected this column once"),
        (
            'decimal: ","',
            'decimal: ",", header: 1400',
            "map.yaml: layout.header: ... v1.csv: expected names of col",
        ),
        (
            "block-1-face.x",
            "mystery.x",
            "map.yaml: columns.mystery.x: ... v1.csv: mystery: expected markers of",
        ),
        (
            "mm\nrest: 0.5",
            "m",
            "map.yaml: displacement_unit: ... v1.csv: marker_displacement: expected metres",
        ),
        (
            "rest: 0.5",
            "",
            "map.yaml: columns.block-1-face.x: ... v1.csv: block-1-face.x: expected displacements since",
        ),
    ],
)
def test_faults_name_the_key_of_the_map(before, after, said, tmp_path, capsys):
    assert _mapped(tmp_path, _same, MAP.replace(before, after)) == 2
    error = capsys.readouterr().err
    assert all(part in error for part in said.split(" ... ")), error
    assert error.count("\n") == 1


@pytest.mark.parametrize("date", ["", "04.03.2026 "])
def test_a_clock_of_the_day_goes_in(date, tmp_path, capsys):
    """Through midnight, at 100 Hz; a clock that falls back by a second is refused."""

    def clock(rows):
        for row in rows:
            at = 86395.0 + float(row[0].replace(",", "."))
            day = date.replace("04", "05") if at >= 86400.0 else date
            at = at % 86400.0
            row[0] = (
                f"{day}{int(at // 3600):02}:{int(at // 60 % 60):02}:{f'{at % 60.0:05.2f}'.replace('.', ',')}"
            )
        return rows

    source, folder = _transducers(tmp_path / "v1.csv", clock), tmp_path / "campaign"
    asked = ["import-campaign", source, *OPTIONS, *COLUMNS, "--rest", "0.5", "--output", str(folder)]
    assert main(asked) == 0
    read = load_test(load_campaign(folder), "v1")
    np.testing.assert_allclose(read["time"], 0.01 * np.arange(1300), atol=1e-12)
    source = _transducers(tmp_path / "v2.csv", lambda rows: _set(300, 0, f"{date}23:59:57,00")(clock(rows)))
    assert main([source if "v1.csv" in word else word for word in asked[:-1]] + [f"{folder}-2"]) == 2
    assert (
        "v2.csv: line 302, Zeit: expected times that increase; 86397 s follows 86397.99 s"
        in capsys.readouterr().err
    )


@pytest.fixture(scope="module")
def filmed(tmp_path_factory):
    """Folder with a run's noisy poses in mm as a table, and its map; and the displacements of the markers by name."""
    folder, generator = tmp_path_factory.mktemp("filmed"), np.random.default_rng(1)
    structure = load_structure("configuration-1")
    run = simulate(structure, load_motion("basso-tirreno", 2.0), "nscd-rigid", duration=4.0)
    table, moved = {"t": run["time"].to_numpy()}, {}
    for body in run["body"].values:
        noise = 1e-4 * generator.normal(size=(2, run.sizes["time"], 3))
        place = run["position"].sel(body=body).to_numpy() + noise[0]
        turn = Rotation.from_quat(run["orientation"].sel(body=body), scalar_first=True)
        turn = Rotation.from_rotvec(noise[1]) * turn
        table |= {f"{body}.{axis}": column for axis, column in zip("xyz", 1e3 * place.T, strict=True)}
        quaternion = turn.as_quat(scalar_first=True)
        table |= {f"{body}.q{part}": column for part, column in zip("wxyz", quaternion.T, strict=True)}
        for marker in structure.file.markers:
            if marker.body == body:
                moved[marker.name] = place + turn.apply(marker.position)
    table = pd.DataFrame(table)
    table.to_csv(folder / "poses.csv", index=False)
    columns = {name: name for name in table.columns[1:]}
    test = {"name": "t1", "file": "poses.csv", "motion": "basso-tirreno", "scale": 2.0, "role": "fit"}
    asked = {"name": "filmed", "structure": "configuration-1", "time": "t", "displacement_unit": "mm"}
    (folder / "map.yaml").write_text(yaml.safe_dump({**asked, "tests": [test], "columns": columns}))
    return folder, {name: values - values[0] for name, values in moved.items()}


def test_poses_of_a_shaken_stack_become_what_its_markers_read(filmed, tmp_path):
    folder, moved = filmed
    assert main(["import-campaign", str(folder / "map.yaml"), "--output", str(tmp_path / "campaign")]) == 0
    campaign = load_campaign(tmp_path / "campaign")
    test = read_test(campaign.folder / campaign.tests["t1"].file, load_structure("configuration-1"))
    assert set(test["marker"].values) == set(moved)
    for name, expected in moved.items():
        np.testing.assert_allclose(test["marker_displacement"].sel(marker=name), expected, atol=1e-9)


def test_a_marker_has_columns_of_its_own_or_a_pose(filmed, tmp_path, capsys):
    folder, _ = filmed
    asked = yaml.safe_load((folder / "map.yaml").read_text())
    table = pd.read_csv(folder / "poses.csv").assign(own=0.0)
    table.to_csv(tmp_path / "poses.csv", index=False)
    asked["columns"]["block-1-face.x"] = "own"
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(asked))
    assert main(["import-campaign", str(tmp_path / "map.yaml"), "--output", str(tmp_path / "campaign")]) == 2
    assert "block-1-face is read from the poses of block-1" in capsys.readouterr().err
    assert not (tmp_path / "campaign").exists()


def test_four_markers_in_a_tetrahedron_know_a_pose_as_well_as_its_film():
    """Independent noise of 2 s at four corners of radius 1.22 s / t is noise s of the place and t of the rotation."""
    place, turn = 1e-4, 2e-4  # m, rad
    radius = np.sqrt(1.5) * place / turn
    corners = radius / np.sqrt(3.0) * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    # displacement of a corner: place + rotation x corner
    rows = np.concatenate([np.column_stack([np.eye(3), np.cross(np.eye(3), corner).T]) for corner in corners])
    covariance = (2.0 * place) ** 2 * np.linalg.inv(rows.T @ rows)
    np.testing.assert_allclose(covariance[:3, :3], place**2 * np.eye(3), atol=1e-20)
    np.testing.assert_allclose(covariance[3:, 3:], turn**2 * np.eye(3), atol=1e-20)
