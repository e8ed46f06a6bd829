"""Lost markers become gaps, found by what no block can do: zeros, standing places, exchanged names."""

import os
from pathlib import Path

import numpy as np
import pytest
from resting_stack import MARKERS, STRUCTURE, resting_stack

from blockshake.cli import main
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.lost_markers import without_lost
from blockshake.measurement.campaigns.recorded_test import read_test

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[4] / "shared")) / "cases"
OWN, OTHER = MARKERS.index("block-1-lower"), MARKERS.index("block-1-upper")
PLACE = np.array([1.5, -0.2, 1.2])  # m, of a marker in the laboratory
TOP = 0.6  # m between two markers


def spoilt(change):
    test = resting_stack()
    change(test["marker_displacement"].values)
    return without_lost(test, STRUCTURE)


def gaps(test, column):
    return np.flatnonzero(np.isnan(test["marker_displacement"].values[:, column]).all(axis=1))


def test_a_sound_test_has_no_lost_marker():
    test = without_lost(resting_stack(), STRUCTURE)
    assert test.attrs["faulty"] == ()
    assert np.isnan(test["marker_displacement"].values).sum() == 9  # its own gap


@pytest.mark.parametrize("length", [1, 2, 3, 5, 9, 20, 200])
@pytest.mark.parametrize("first", [300, 500])
def test_zeros_of_any_length_are_gaps(length, first):
    def lose(values):
        values[first : first + length, OWN] = -PLACE

    test = spoilt(lose)
    np.testing.assert_array_equal(gaps(test, OWN), np.arange(first, first + length))
    (fault,) = test.attrs["faulty"]
    assert (fault.sensor, fault.kind) == ("block-1-lower", "lost")
    assert f"{float(test['time'][first]):.4g} s" in fault.words


def test_zeros_that_come_and_go_are_all_gaps():
    rows = np.array([310, 311, 360, 400, 401, 402, 900])

    def lose(values):
        values[rows, OWN] = -PLACE

    np.testing.assert_array_equal(gaps(spoilt(lose), OWN), rows)


def test_the_last_readings_lost_are_gaps():
    def lose(values):
        values[-30:, OWN] = -PLACE

    assert len(gaps(spoilt(lose), OWN)) == 30


@pytest.mark.parametrize("length", [4, 8])
def test_a_place_that_stands_while_others_move_is_a_gap(length):
    def lose(values):
        values[500 : 500 + length, OWN] = values[499, OWN]

    np.testing.assert_array_equal(gaps(spoilt(lose), OWN), np.arange(500, 500 + length))


def test_names_that_are_exchanged_in_mid_test_are_gaps_from_there_on():
    def exchange(values):
        values[900:, OWN, 2] += TOP
        values[900:, OTHER, 2] -= TOP

    test = spoilt(exchange)
    for column in (OWN, OTHER):
        lost = gaps(test, column)
        assert lost.min() >= 900 or lost.max() < 900  # the longer part stands
    assert {fault.sensor for fault in test.attrs["faulty"]} == {"block-1-lower", "block-1-upper"}


def test_a_block_that_falls_freely_is_not_lost():
    """A fall of 4 m, at the end with 9 m/s."""

    def fall(values):
        time = 0.005 * np.arange(180)
        values[800:980, OWN, 2] -= 0.5 * 9.81 * time**2
        values[980:, OWN, 2] -= 0.5 * 9.81 * time[-1] ** 2

    assert spoilt(fall).attrs["faulty"] == ()


def test_an_outlier_along_one_axis_is_a_gap():
    def leap(values):
        values[700, OWN, 1] += 0.5

    np.testing.assert_array_equal(gaps(spoilt(leap), OWN), [700])


def table(folder, place, lost, zero="0.000"):
    """A map and a table of a motion capture in mm; the marker of the block is lost at some rows."""
    (folder / "wall.yaml").write_text("""\
name: wall
materials: {c: {density: 2400, youngs_modulus: 3.0e10, poisson_ratio: 0.2}}
shapes: {s: {box: [2, 2, 0.2]}, b: {box: [0.5, 1, 1]}}
bodies:
  - {name: slab, shape: s, material: c, position: [0, 0, -0.1], driven: true}
  - {name: block, shape: b, material: c, position: [0, 0, 0.5]}
friction: [{pair: [c, c], coefficient: 0.7}]
markers: [{name: slab-m, body: slab, position: [0, -1, 0]}, {name: top, body: block, position: [0, -0.5, 0.4]}]
""")
    (folder / "map.yaml").write_text("""\
name: test
structure: wall.yaml
time: Time
displacement_unit: mm
rest: 0.5
columns: {slab-m.x: SX, slab-m.y: SY, slab-m.z: SZ, top.x: TX, top.y: TY, top.z: TZ}
tests: [{name: t1, file: take.csv, motion: command.csv, scale: 1.0, role: fit}]
""")
    time = np.arange(400) / 100
    moved = np.where(time > 1, 0.015 * np.sin(2 * np.pi * (time - 1)) ** 3, 0.0)
    lines = [f"{t},{x:.6f}" for t, x in zip(time, moved, strict=True)]
    (folder / "command.csv").write_text("\n".join(["time_s,displacement_x", *lines]) + "\n")
    noise = np.random.default_rng(5).normal(0.0, 1e-4, (len(time), 6))
    places = 1e3 * (np.array([*place[0], *place[1]]) + noise + np.outer(moved, [1, 0, 0, 1, 0, 0]))
    cells = [[f"{value:.3f}" for value in row] for row in places]
    for row in lost:
        cells[row][3:] = [zero] * 3
    rows = [",".join([f"{t:.2f}", *own]) for t, own in zip(time, cells, strict=True)]
    (folder / "take.csv").write_text("\n".join(["Time,SX,SY,SZ,TX,TY,TZ", *rows]) + "\n")
    return moved


@pytest.mark.parametrize("zero", ["0.000", "0", "-0.0"])
@pytest.mark.parametrize("lost", [[150], [0, 1, 2], [20, 21, 300], list(range(200, 260))])
@pytest.mark.parametrize("place", [(0.3, -1.0, 0.2), (0.03, 0.0, 0.02), (4.0, 3.0, 2.0)])
def test_an_import_takes_zeros_as_gaps_wherever_the_laboratory_has_its_origin(
    zero, lost, place, tmp_path, capsys
):
    moved = table(tmp_path, ((0.5, -0.9, 0.01), place), lost, zero)
    assert main(["import-campaign", str(tmp_path / "map.yaml"), "--output", str(tmp_path / "made")]) == 0
    printed = capsys.readouterr().out
    assert "lost by the cameras at" in printed
    assert "taken as gaps: top" in printed
    read = load_test(load_campaign(tmp_path / "made"), "t1").sel(marker="top", axis="x")[
        "marker_displacement"
    ]
    known = read.dropna("time")
    expected = np.interp(known["time"], np.arange(400) / 100, moved)
    assert len(known) == 400 - len(lost)
    np.testing.assert_allclose(known, expected, atol=6e-4)


@pytest.mark.parametrize(
    ("name", "marker", "count"),
    [
        ("one-frame", "top", "1 reading,"),
        ("three-frames", "top", "3 readings,"),
        ("twenty-frames", "top", "20 readings,"),
        ("slab-one-frame", "slab-m", "1 reading,"),
    ],
)
@pytest.mark.skipif(not CASES.is_dir(), reason=f"no {CASES} (set BLOCKSHAKE_SHARED)")
def test_zeros_of_an_export_are_gaps(name, marker, count, tmp_path, capsys):
    case, made = CASES / "occluded-marker-zeros", tmp_path / "made"
    assert main(["import-campaign", str(case / f"{name}.yaml"), "--output", str(made)]) == 0
    assert f"lost by the cameras at 2.5 s, {count} taken as gaps: {marker}" in capsys.readouterr().out
    test = read_test(made / f"{name}.nc", load_structure(made / "structure.yaml"))
    assert np.abs(test["marker_displacement"].sel(marker=marker)).max() < 0.05
