"""Exports as motion capture and loggers write them are mapped as they are, with true values, or say where to look."""

import io
import shutil

import numpy as np
import pytest
import yaml

from blockshake.cli import main
from blockshake.measurement.campaigns.campaign import load_campaign, load_test

TIME = np.arange(300) / 100.0
SHAKE = 0.02 * np.sin(4.0 * np.pi * TIME) * (TIME > 0.5)  # m
TOP = 1.5 * SHAKE
STRUCTURE = """\
name: block
materials: {c: {density: 2400, youngs_modulus: 3.0e10, poisson_ratio: 0.2}}
shapes: {b: {box: [0.4, 0.4, 1.2]}, s: {box: [3, 1, 0.2]}}
bodies:
  - {name: slab, shape: s, material: c, position: [0, 0, -0.1], driven: true}
  - {name: block, shape: b, material: c, position: [0, 0, 0.6]}
friction: [{pair: [c, c], coefficient: 0.6}]
markers:
  - {name: base, body: slab, position: [0, -0.5, 0]}
  - {name: top, body: block, position: [0, -0.2, 0.6]}
accelerometers: [{name: acc, body: slab, position: [0, 0, 0], axes: [x]}]
displacement_transducers:
  - {name: wire, body: block, position: [-0.2, 0, 0], reference: slab, reference_position: [-1, 0, 0.7]}
"""
# x, y and z of each marker [mm], in a laboratory's origin
PLACES = {
    "base": 1e3 * np.column_stack([SHAKE + 1.0, 0 * TIME + 1.5, 0 * TIME + 0.5]),
    "top": 1e3 * np.column_stack([TOP + 1.0, 0 * TIME + 1.8, 0 * TIME + 1.7]),
}
NOISE = 0.1 * np.random.default_rng(1).normal(size=(len(TIME), 6))  # mm
CELLS = np.column_stack([*PLACES.values()]) + NOISE


def imported(folder, capsys, mapped=None, text=None, other=None, **settings):
    """Exit code and printed text of the import of ``take.csv``, and of ``log.csv`` of another instrument."""
    (folder / "block.yaml").write_text(STRUCTURE)
    rows = [f"{t:.2f},{x:.9f}" for t, x in zip(TIME, SHAKE, strict=True)]
    (folder / "command.csv").write_text("\n".join(["time_s,displacement_x", *rows]) + "\n")
    test = {"name": "t1", "file": "take.csv", "motion": "command.csv", "scale": 1.0, "role": "fit"}
    if text is not None:
        (folder / "take.csv").write_text(text)
    if other is not None:
        (folder / "log.csv").write_text(other)
        test["accelerometers"] = "log.csv"
    mapping = {"name": "take", "structure": "block.yaml", "displacement_unit": "mm", "rest": 0.4}
    mapping |= {"columns": mapped} | settings
    (folder / "map.yaml").write_text(yaml.safe_dump(mapping | {"tests": [test]}))
    shutil.rmtree(folder / "made", ignore_errors=True)
    code = main(["import-campaign", str(folder / "map.yaml"), "--output", str(folder / "made")])
    printed = capsys.readouterr()
    return code, printed.out + printed.err


def assert_true(folder, axis="x"):
    """To three times the noise of a reading and of the first one."""
    test = load_test(load_campaign(folder / "made"), "t1")
    assert test.attrs["follows"]
    time = test["time"].to_numpy()
    for marker, moved in (("base", SHAKE), ("top", TOP)):
        read = test["marker_displacement"].sel(marker=marker, axis=axis)
        np.testing.assert_allclose(read, np.interp(time, TIME - TIME[0], moved), atol=6e-4)
    return test


def table(columns, separator=",", decimal="."):
    stream = io.StringIO()
    np.savetxt(stream, np.column_stack(columns), "%.6f", separator)
    return stream.getvalue().replace(".", decimal)


XYZ = {f"{name}.{axis}": f"{name} {axis.upper()}" for name in PLACES for axis in "xyz"}


def test_names_of_bodies_above_x_y_z_and_frames_at_a_rate(tmp_path, capsys):
    """Trajectories of Vicon: a name over three columns, units below, frames and no times, another section below."""
    head = "Trajectories\n100\n,,base,,,top,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n"
    body = table([np.arange(1, 301), 0 * TIME, CELLS])
    foot = "\nDevices\n1000\nFrame,Sub Frame,V\n1,0,0.5\n1,1,0.5\n"
    layout = {"header": [3, 4], "data": 6, "last": 305}
    code, printed = imported(
        tmp_path, capsys, XYZ, head + body + foot, layout=layout, time={"column": "Frame", "rate": 100}
    )
    assert code == 0, printed
    assert_true(tmp_path)


def test_a_name_in_every_column_and_the_quantity_below_it(tmp_path, capsys):
    """Markers of Motive: types, names, identities, quantities and axes in five lines, y up, in metres."""
    up = CELLS[:, [0, 2, 1, 3, 5, 4]] * [1, 1, -1, 1, 1, -1] / 1e3
    names = ["base"] * 3 + ["top"] * 3
    head = [
        "Format Version,1.23,Take Name,t1,Capture Frame Rate,100.000000",
        "",
        ",," + ",".join(["Marker"] * 6),
    ]
    head += [
        ",," + ",".join(names),
        ",," + ",".join(['"A1"'] * 3 + ['"B2"'] * 3),
        ",," + ",".join(["Position"] * 6),
    ]
    head += ["Frame,Time (Seconds),X,Y,Z,X,Y,Z"]
    text = "\n".join(head) + "\n" + table([np.arange(300), TIME, up])
    mapped = {}
    for name in PLACES:
        mapped |= {f"{name}.x": f"{name} Position X", f"{name}.z": f"{name} Position Y"}
        mapped[f"{name}.y"] = {"column": f"{name} Position Z", "reversed": True}
    settings = {"layout": {"header": [4, 6, 7]}, "time": "Time (Seconds)", "displacement_unit": "m"}
    code, printed = imported(tmp_path, capsys, mapped, text, **settings)
    assert code == 0, printed
    assert_true(tmp_path)
    # the same file with the layout left out says where to look
    code, printed = imported(tmp_path, capsys, mapped, text, **settings | {"layout": {}})
    assert code == 2
    assert "numbers begin in line 8 below lines 4, 5, 6, 7 of as many cells" in printed
    code, printed = imported(tmp_path, capsys, mapped, text, **settings | {"layout": {"header": 7}})
    assert code == 2
    wrong = "column 'base Position X': expected this column once; there are Frame, Time (Seconds), X, Y, Z, X, Y, Z"
    assert wrong in printed
    assert "names are of line 7, numbers from line 8 on" in printed


def test_columns_by_their_number_where_names_are_not_above_them(tmp_path, capsys):
    """A table of Qualisys: names of markers in one line of the header, no line of columns, a rate and no times."""
    head = "NO_OF_FRAMES\t300\nFREQUENCY\t100\nMARKER_NAMES\tbase\ttop\n"
    mapped = {key: str(number) for number, key in enumerate(XYZ, start=1)}
    settings = {"layout": {"header": 4}, "time": {"rate": 100}}
    code, printed = imported(tmp_path, capsys, mapped, head + table([CELLS], "\t"), **settings)
    assert code == 0, printed
    assert_true(tmp_path)


def test_a_name_that_stands_twice_may_be_a_number(tmp_path, capsys):
    text = "t,X,Y,Z,X,Y,Z\n" + table([TIME, CELLS])
    names = {f"{name}.{axis}": axis.upper() for name in PLACES for axis in "xyz"}
    code, printed = imported(tmp_path, capsys, names, text, time="t")
    assert code == 2
    assert "expected a column of its own; 'X' is base.x; of several of one name a number names one" in printed
    code, printed = imported(tmp_path, capsys, {"base.x": "X", "top.x": "5"}, text, time="t")
    assert code == 2
    assert (
        "column 'X': expected this column once; it stands in the columns 2, 5, and such a number names"
        in printed
    )
    numbers = {key: number for number, key in enumerate(names, start=2)}
    code, printed = imported(tmp_path, capsys, numbers, text, time="t")
    assert code == 0, printed
    assert_true(tmp_path)


def test_a_time_before_every_channel(tmp_path, capsys):
    """As LabVIEW writes several waveforms; the second channel begins three rows later and has fewer."""
    late = np.full((300, 2), np.nan)
    late[:297] = np.column_stack([TIME, CELLS[:, 3]])[3:]
    text = "Time,W1,Time,W2\n" + table([TIME, CELLS[:, 0], late]).replace("nan", "")
    mapped = {"base.x": "W1", "top.x": "W2"}
    code, printed = imported(tmp_path, capsys, mapped, text, time="Time")
    assert code == 0, printed
    test = load_test(load_campaign(tmp_path / "made"), "t1")
    read = test["marker_displacement"].sel(axis="x")
    np.testing.assert_allclose(read.sel(marker="base"), SHAKE, atol=6e-4)
    np.testing.assert_allclose(read.sel(marker="top")[3:], TOP[3:], atol=6e-4)
    assert np.isnan(read.sel(marker="top")[:3]).all()


def test_channels_that_are_read_one_after_the_other_are_read_between_their_times(tmp_path, capsys):
    """Half a step later: on the line between two readings, with a remark."""
    later = TIME + 0.005
    shifted = 1e3 * 1.5 * 0.02 * np.sin(4.0 * np.pi * later) * (later > 0.5)
    text = "T1,W1,T2,W2\n" + table([TIME, 1e3 * SHAKE, later, shifted])
    mapped = {"base.x": "W1", "top.x": {"column": "W2", "time": "T2"}}
    code, printed = imported(tmp_path, capsys, mapped, text, time="T1")
    assert code == 0, printed
    assert "top.x: read between its own times, up to 0.005 s off the others'" in printed
    read = load_test(load_campaign(tmp_path / "made"), "t1")["marker_displacement"].sel(
        axis="x", marker="top"
    )
    away = np.abs(read[1:] - TOP[1:])
    assert float(away.max()) < 3e-3  # where the motion begins with a kink
    assert (
        float(away[60:].max()) < 1.5e-4
    )  # the line below an arc of 2 Hz and 30 mm: a (w dt)^2 / 8 = 0.06 mm


def logger(zero=0.0):
    """A logger's table at 200 Hz in ms, with a decimal comma and five lines above: g, cm and mm."""
    at = np.arange(600) / 200.0
    moved = 0.02 * np.sin(4.0 * np.pi * at) * (at > 0.5)
    acceleration = -((4.0 * np.pi) ** 2) * moved / 9.80665
    noise = 0.1 * np.random.default_rng(2).normal(size=600)
    head = "Logger 7\nKanal;1;2\n\nZeit;A1;S1;W1\nms;g;cm;mm\n"
    return head + table([1e3 * (at + zero), acceleration, 50.0 * moved, 1e3 * moved + noise], ";", ",")


RECORDER = {"layout": {"header": 4, "data": 6, "decimal": ","}, "time": {"column": "Zeit", "unit": "ms"}}


def test_optics_beside_a_logger_with_layout_time_and_unit_of_its_own(tmp_path, capsys):
    text = "t,base X,base Y,base Z,top X,top Y,top Z\n" + table([TIME, CELLS])
    settings = {
        "time": "t",
        "acceleration_unit": "g",
        "accelerometers": RECORDER | {"displacement_unit": "cm"},
    }
    code, printed = imported(
        tmp_path, capsys, XYZ | {"acc-x": "A1", "wire": "S1"}, text, logger(), **settings
    )
    assert code == 0, printed
    test = assert_true(tmp_path)
    at = test["time_acc"].to_numpy()
    true = np.where(at > 0.501, -((4.0 * np.pi) ** 2) * 0.02 * np.sin(4.0 * np.pi * at), 0.0)
    np.testing.assert_allclose(test["accelerometer"].sel(channel="acc-x"), true, atol=5e-3)
    wire = np.where(at > 0.501, 0.01 * np.sin(4.0 * np.pi * at), 0.0)  # 50 cm of a metre
    np.testing.assert_allclose(test["transducer_displacement"].sel(transducer="wire"), wire, atol=1e-5)


def test_a_marker_of_the_logger_is_read_at_the_times_of_the_optics(tmp_path, capsys):
    text = "t,top X,top Y,top Z\n" + table([TIME, CELLS[:, 3:]])
    mapped = {key: one for key, one in XYZ.items() if key.startswith("top")}
    mapped["base.x"] = {"column": "W1", "recorder": True}
    settings = {"time": "t", "accelerometers": RECORDER}
    code, printed = imported(tmp_path, capsys, mapped, text, logger(), **settings)
    assert code == 0, printed
    assert "base.x of the recorder: both clocks are taken to have the same zero" in printed
    assert_true(tmp_path)
    code, printed = imported(tmp_path, capsys, mapped, text, logger(7000.0), **settings)
    assert code == 2
    assert "columns.base.x.recorder: expected the clock of the others, 0 to 2.99 s, not 7000 to" in printed


@pytest.mark.parametrize(
    ("changes", "wrong"),
    [
        ({"layout": {"header": 3, "data": 6, "decimal": ","}}, "accelerometers.layout"),
        ({"time": {"column": "Zeit", "unit": "hours"}}, "accelerometers.time.unit: expected a unit of time"),
        ({"displacement_unit": "inch"}, "accelerometers.displacement_unit: expected a unit"),
    ],
)
def test_faults_of_the_logger_name_its_keys(changes, wrong, tmp_path, capsys):
    text = "t,base X,base Y,base Z,top X,top Y,top Z\n" + table([TIME, CELLS])
    settings = {"time": "t", "acceleration_unit": "g", "accelerometers": RECORDER | changes}
    code, printed = imported(
        tmp_path, capsys, XYZ | {"acc-x": "A1", "wire": "S1"}, text, logger(), **settings
    )
    assert code == 2
    assert wrong in printed


@pytest.mark.parametrize(
    ("time", "wrong"),
    [
        ({"column": "t", "rate": 100, "unit": "s"}, "map.yaml: time: expected a unit or a rate, not both"),
        ({"unit": "s"}, "map.yaml: time: expected a column of times, or the rate of the frames"),
        ({"column": "t", "rate": 100}, "expected a frame's number, not 0.01; with times no rate"),
    ],
)
def test_frames_have_a_rate_and_no_unit(time, wrong, tmp_path, capsys):
    text = "t,base X,base Y,base Z,top X,top Y,top Z\n" + table([TIME, CELLS])
    code, printed = imported(tmp_path, capsys, XYZ, text, time=time)
    assert code == 2
    assert wrong in printed


def test_frames_that_were_lost_are_gaps(tmp_path, capsys):
    text = "n,base X,base Y,base Z,top X,top Y,top Z\n"
    text += table([np.arange(300), CELLS]).replace("\n150", "\n150", 1)
    lines = [line for line in text.splitlines() if not line.startswith(("150.", "151."))]
    settings = {"time": {"column": "n", "rate": 100}, "fill_gaps": True}
    code, printed = imported(tmp_path, capsys, XYZ, "\n".join(lines), **settings)
    assert code == 0, printed
    read = load_test(load_campaign(tmp_path / "made"), "t1")["marker_displacement"].sel(
        marker="base", axis="x"
    )
    assert np.flatnonzero(read.isnull()).tolist() == [150, 151]


def test_single_zeros_of_a_logger_are_gaps(tmp_path, capsys):
    """An offset of 57 cm, and a contact that is lost twice; the accelerometer passes through 0 as it should."""
    lines = logger().splitlines()
    cells = [line.split(";") for line in lines]
    for row, line in enumerate(cells[5:]):
        line[2] = "0,000000" if row in (300, 301, 450) else f"{float(line[2].replace(',', '.')) + 57.0:.6f}"
        line[1] = "0,000000" if row == 130 else line[1]
        line[2] = line[2].replace(".", ",")
    text = "t,base X,base Y,base Z,top X,top Y,top Z\n" + table([TIME, CELLS])
    settings = {
        "time": "t",
        "acceleration_unit": "g",
        "accelerometers": RECORDER | {"displacement_unit": "cm"},
    }
    mapped = XYZ | {"acc-x": "A1", "wire": "S1"}
    other = "\n".join(";".join(line) for line in cells)
    code, printed = imported(tmp_path, capsys, mapped, text, other, **settings)
    assert code == 0, printed
    assert "0 between readings far from it, first at 1.5 s (3 in all), taken as gaps: wire" in printed
    test = load_test(load_campaign(tmp_path / "made"), "t1")
    wire = test["transducer_displacement"].sel(transducer="wire").to_numpy()
    assert np.flatnonzero(np.isnan(wire)).tolist() == [300, 301, 450]
    assert np.nanmax(np.abs(wire)) < 0.011
