"""Components in files of their own, reversed ones, and values without times."""

import numpy as np
import pytest

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError

TIME = 0.01 * np.arange(403)
SHAPES = {
    axis: np.sin(k * TIME) * np.sin(np.pi * TIME / TIME[-1]) ** 2
    for axis, k in zip("xyz", (5, 7, 11), strict=True)
}


def at2(path, values, component, event="EVENT, 1/1/2026, STATION", step=0.01):
    head = f"PEER\n{event}, {component}\nACCELERATION TIME SERIES IN UNITS OF G\n"
    head += f"NPTS= {len(values)}, DT= {step:.4f} SEC\n"
    cells = [f"{value:15.7E}" for value in values]
    path.write_text(head + "\n".join("".join(cells[at : at + 5]) for at in range(0, len(cells), 5)) + "\n")


def acceleration(path, **options):
    motion = load_motion(path, baseline="none", **options)
    return motion.evaluate(TIME[:-1] + 1e-9, 2) / 9.80665


@pytest.fixture
def files(tmp_path):
    for axis, name in zip("xyz", ("090", "180", "UP"), strict=True):
        at2(tmp_path / f"{axis}.AT2", SHAPES[axis], name)
    return tmp_path


def test_three_files_make_one_motion_and_each_may_be_reversed(files):
    components = {"y": str(files / "y.AT2"), "z": f"-{files / 'z.AT2'}"}
    read = acceleration(files / "x.AT2", channels={"x": "-1"}, components=components)
    for column, (axis, sign) in enumerate((("x", -1.0), ("y", 1.0), ("z", -1.0))):
        np.testing.assert_allclose(read[:, column], sign * SHAPES[axis][:-1], atol=1e-6)
    motion = load_motion(files / "x.AT2", channels={"x": "-1"}, components=components)
    assert "x is reversed" in motion.attributes["assumed"]
    assert "z is reversed" in motion.attributes["assumed"]


def test_the_command_joins_files_too(files):
    out = files / "out.csv"
    call = [
        "convert-motion",
        str(files / "x.AT2"),
        "--component",
        f"y=-{files / 'y.AT2'}",
        "--baseline",
        "none",
    ]
    assert main([*call, "--component", f"z={files / 'z.AT2'}", "--output", str(out)]) == 0
    read = np.loadtxt(out, delimiter=",", skiprows=1)
    for column, (axis, sign) in enumerate((("x", 1.0), ("y", -1.0), ("z", 1.0)), start=1):
        np.testing.assert_allclose(read[:, column], sign * 9.80665 * SHAPES[axis], atol=1e-5)


def test_a_shorter_component_rests_behind_its_end(files):
    at2(files / "y.AT2", SHAPES["y"][:300], "180")
    read = acceleration(files / "x.AT2", components={"y": files / "y.AT2"})
    np.testing.assert_allclose(read[:300, 1][:-1], SHAPES["y"][:299], atol=1e-6)
    assert not read[301:, 1].any()
    motion = load_motion(files / "x.AT2", components={"y": files / "y.AT2"})
    assert "rest for 1.03 s behind its end" in motion.attributes["assumed"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"event": "OTHER, 1/1/2026, STATION"}, "event: expected that of"),
        ({"step": 0.005}, "expected the time step of"),
        ({"component": "UP"}, "expected a horizontal component, found 'UP'"),
    ],
)
def test_components_of_two_records_are_refused(change, words, files):
    at2(files / "y.AT2", SHAPES["y"], **{"component": "180"} | change)
    with pytest.raises(InputError, match=words):
        load_motion(files / "x.AT2", components={"y": files / "y.AT2"})


def test_an_axis_has_one_component(files):
    with pytest.raises(InputError, match="expected no second one"):
        load_motion(files / "x.AT2", components={"x": files / "y.AT2"})


def converted(path, *options, unit="m/s2"):
    out = path.with_name("out.csv")
    code = main(["convert-motion", str(path), "--unit", unit, *options, "--output", str(out)])
    return np.loadtxt(out, delimiter=",", skiprows=1) if code == 0 else code


@pytest.mark.parametrize("width", [1, 5, 8])
@pytest.mark.parametrize("head", [(), ("A record of somewhere", "Units: m/s2")])
def test_values_without_times_are_read_line_by_line(width, head, tmp_path):
    cells = [f"{value:.6f}" for value in SHAPES["x"]]
    lines = [" ".join(cells[at : at + width]) for at in range(0, len(cells), width)]
    (tmp_path / "in.txt").write_text("\n".join([*head, *lines]) + "\n")
    read = converted(tmp_path / "in.txt", "--step", "0.01")
    np.testing.assert_allclose(read[:, 0], TIME, atol=1e-12)
    np.testing.assert_allclose(read[:, 1], SHAPES["x"], atol=1e-6)


def test_values_that_touch_and_decimal_commas(tmp_path):
    cells = [f"{value:9.6f}" for value in SHAPES["x"] - 2.0]
    (tmp_path / "in.txt").write_text("\n".join("".join(cells[at : at + 8]) for at in range(0, 403, 8)))
    np.testing.assert_allclose(
        converted(tmp_path / "in.txt", "--step", "0.01")[:, 1], SHAPES["x"] - 2.0, atol=1e-6
    )
    (tmp_path / "in.txt").write_text("\n".join(cells).replace(".", ","))
    read = converted(tmp_path / "in.txt", "--step", "0.01", "--decimal", ",")
    np.testing.assert_allclose(read[:, 1], SHAPES["x"] - 2.0, atol=1e-6)


@pytest.mark.parametrize(
    ("head", "words"),
    [
        (["403"], "line 1: expected a value, found 403, the number of the others"),
        (["403", "0.01"], "line 1: expected a value, found 403, the number of the others"),
        (["0.01"], "line 1: expected a value, found 0.01, the step"),
        (["403 0.01"], "expected 2 values, as in other lines, found 1"),
    ],
)
def test_a_header_of_numbers_is_no_value(head, words, tmp_path, capsys):
    cells = [f"{value:.6f}" for value in SHAPES["x"]]
    (tmp_path / "in.txt").write_text("\n".join([*head, *cells]) + "\n")
    assert converted(tmp_path / "in.txt", "--step", "0.01") == 2
    assert words in capsys.readouterr().err
    read = converted(tmp_path / "in.txt", "--step", "0.01", "--data", str(1 + len(head)))
    np.testing.assert_allclose(read[:, 1], SHAPES["x"], atol=1e-6)


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("ACC IN CM/S2 NPTS 403 DT 0.01", "line 2: expected m/s2, as --unit gives; the header states cm/s2"),
        (
            "ACCELERATION TIME SERIES IN UNITS OF G",
            "line 2: expected m/s2, as --unit gives; the header states g",
        ),
        ("Velocity (cm/s)", "line 2: expected m/s2, as --unit gives; the header states cm/s"),
        ("DT = 0.005 sec", "line 2: expected a step of 0.01 s, as --step gives; the header states 0.005 s"),
        (
            "Sampling rate (Hz): 200",
            "line 2: expected a step of 0.01 s, as --step gives; the header states 0.005 s",
        ),
        (
            "time step [ms]: 5",
            "line 2: expected a step of 0.01 s, as --step gives; the header states 0.005 s",
        ),
        ("UNITS ARE SECONDS AND G/10", "line 2: expected m/s2, as --unit gives; the header states g/10"),
        (
            "#AmplitudeUnit:  gal. DCoffset(corr)",
            "line 2: expected m/s2, as --unit gives; the header states cm/s2",
        ),
        (
            "NO. OF POINTS =    403      DURATION =   2.015",
            "line 2: expected a step of 0.01 s, as --step gives; the header states 0.005 s",
        ),
        ("NPTS=  411, DT=  .0100 SEC", "line 2: expected 411 values, as the header states, found 403"),
        ("Number of points: 404", "line 2: expected 404 values, as the header states, found 403"),
    ],
)
def test_a_header_that_contradicts_an_option_is_refused(head, words, tmp_path, capsys):
    cells = [f"{value:.6f}" for value in SHAPES["x"]]
    (tmp_path / "in.txt").write_text("\n".join(["STATION G", head, *cells]) + "\n")
    assert converted(tmp_path / "in.txt", "--step", "0.01") == 2
    assert f"in.txt: {words}" in capsys.readouterr().err
    # the same above a table
    (tmp_path / "in.txt").write_text(
        "\n".join(["STATION G", head, "EW;NS", *(f"{cell};1" for cell in cells)]) + "\n"
    )
    assert converted(tmp_path / "in.txt", "--step", "0.01", "--header", "3", "--column", "x=EW") == 2
    assert f"in.txt: {words}" in capsys.readouterr().err


@pytest.mark.parametrize(
    "head",
    [
        "ACC IN M/S/S NPTS 403 DT 0.01", "Units: m/sec^2", "PEAK ACC 115.2 CM/S2 AT 4.3 S", "ALTITUDE IN M 250",
        "PGV (cm/s): 12.3", "Height above sea in m", "dt 10 ms, 403 values", "Sampling frequency 100 Hz",
        "in g and in m/s2: the second", "STATION MM G", "time interval .01",
        "DT 1/100 s", "SAMPLING RATE 0.01 SEC", "sampling interval (ms) = 1.0E1", "Units: Gal or m/s2",
    ],
)  # fmt: skip
def test_a_header_that_agrees_or_tells_of_others_is_read(head, tmp_path):
    (tmp_path / "in.txt").write_text("\n".join([head, *(f"{value:.6f}" for value in SHAPES["x"])]) + "\n")
    np.testing.assert_allclose(converted(tmp_path / "in.txt", "--step", "0.01")[:, 1], SHAPES["x"], atol=1e-6)


def test_values_in_order_go_along_any_axis(tmp_path, capsys):
    cells = [f"{value:.6f}" for value in SHAPES["x"]]
    lines = ["A record of somewhere", *(" ".join(cells[at : at + 8]) for at in range(0, len(cells), 8))]
    (tmp_path / "in.txt").write_text("\n".join(lines) + "\n")
    assert converted(tmp_path / "in.txt", "--step", "0.01", "--column", "z=-values") is not None
    motion = load_motion(tmp_path / "out.csv")
    np.testing.assert_allclose(motion.evaluate(TIME[:-1] + 1e-9, 2)[:, 2], -SHAPES["x"][:-1], atol=1e-5)
    assert converted(tmp_path / "in.txt", "--step", "0.01", "--column", "y=1") == 2
    assert "--column x=values takes all numbers in order" in capsys.readouterr().err


def test_files_of_values_are_components_and_shorter_ones_rest(tmp_path):
    for axis, count in (("x", 403), ("y", 303), ("z", 403)):
        (tmp_path / f"{axis}.txt").write_text(
            "\n".join(f"{value:.6f}" for value in SHAPES[axis][:count]) + "\n"
        )
    components = "--component", f"y=-{tmp_path / 'y.txt'}", "--component", f"z={tmp_path / 'z.txt'}"
    read = converted(tmp_path / "x.txt", "--step", "0.01", *components, unit="cm/s2")
    expected = 0.01 * np.stack([SHAPES["x"], -SHAPES["y"], SHAPES["z"]], axis=1)
    expected[303:, 1] = 0.0
    np.testing.assert_allclose(read[:, 1:], expected, atol=1e-8)
    motion = load_motion(tmp_path / "out.csv")
    assert motion.attributes["components"] == "y: y.txt, z: z.txt"
    assert "y is reversed" in motion.attributes["assumed"]
    assert "y.txt: rest for 1 s behind its end" in motion.attributes["assumed"]


def test_tables_are_components_and_so_are_files_of_the_project(tmp_path, capsys):
    for axis in "xy":
        rows = [f"{at:.2f};{value:.6f}" for at, value in zip(TIME, SHAPES[axis], strict=True)]
        (tmp_path / f"{axis}.csv").write_text("station\nt;acc (cm/s2)\n" + "\n".join(rows) + "\n")
    (tmp_path / "z.txt").write_text("\n".join(f"{value:.6f}" for value in SHAPES["z"]) + "\n")
    form = "--header", "2", "--time", "t", "--column", "x=acc (cm/s2)"
    call = tmp_path / "x.csv", *form, "--component"
    assert converted(*call, f"y={tmp_path / 'z.txt'}", unit="cm/s2") == 2
    assert "convert each to a CSV, and join these by --component" in capsys.readouterr().err
    assert converted(*call, f"x={tmp_path / 'y.csv'}", unit="cm/s2") == 2
    assert "--component: x: expected no second one" in capsys.readouterr().err
    both = converted(*call, f"y={tmp_path / 'y.csv'}", unit="cm/s2")
    np.testing.assert_allclose(both[:, 1:], 0.01 * np.stack([SHAPES["x"], SHAPES["y"]], axis=1), atol=1e-8)
    (tmp_path / "out.csv").rename(tmp_path / "xy.csv")
    assert converted(tmp_path / "z.txt", "--step", "0.01", unit="cm/s2") is not None
    motion = load_motion(tmp_path / "xy.csv", components={"z": f"-{tmp_path / 'out.csv'}"})
    np.testing.assert_allclose(
        motion.evaluate(TIME[:-1] + 1e-9, 2)[:, :3],
        0.01 * np.stack([SHAPES["x"], SHAPES["y"], -SHAPES["z"]], axis=1)[:-1], atol=1e-6,
    )  # fmt: skip
    with pytest.raises(InputError, match=r"z\.txt: time_s: expected this column"):
        load_motion(tmp_path / "xy.csv", components={"z": tmp_path / "z.txt"})


def test_components_of_other_times_are_refused(tmp_path):
    for name, step in (("x", 0.01), ("y", 0.02)):
        rows = [f"{step * row:.2f},{value:.6f}" for row, value in enumerate(SHAPES[name])]
        (tmp_path / f"{name}.csv").write_text("time_s,acceleration_x\n" + "\n".join(rows) + "\n")
    with pytest.raises(
        InputError, match=r"y.csv: expected the times of .*x.csv, 0.01 s in row 2, found 0.02 s"
    ):
        load_motion(tmp_path / "x.csv", components={"y": tmp_path / "y.csv"})


def test_text_between_values_is_refused(tmp_path, capsys):
    (tmp_path / "in.txt").write_text("0.1 0.2\n0.3 0.4\nend of data\n")
    assert converted(tmp_path / "in.txt", "--step", "0.01") == 2
    assert "line 3: expected values alone, not 'end of data'" in capsys.readouterr().err


def test_rows_of_a_table_with_a_step_for_a_clock(tmp_path):
    rows = [f"{row},{x:.6f},{y:.6f}" for row, (x, y) in enumerate(zip(SHAPES["x"], SHAPES["y"], strict=True))]
    (tmp_path / "in.csv").write_text("frame,EW,NS\n" + "\n".join(rows) + "\n")
    options = "--step", "0.01", "--column", "x=-NS", "--column", "y=EW"
    read = converted(tmp_path / "in.csv", *options)
    np.testing.assert_allclose(read, np.stack([TIME, -SHAPES["y"], SHAPES["x"]], axis=1), atol=1e-6)


def test_the_refusal_of_another_file_names_the_step(tmp_path):
    (tmp_path / "in.txt").write_text("0.1\n0.2\n")
    with pytest.raises(InputError, match="with --step values without times"):
        load_motion(tmp_path / "in.txt")
