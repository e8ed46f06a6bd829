"""Markers of two bodies that were exchanged are remarked, and those of columns that rock, slide or lean are not."""

import itertools

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.geometry.structure import load_structure
from blockshake.measurement.checks.exchanged import exchange_remarks
from blockshake.measurement.sensors.instruments import Sensors

TIME = np.arange(600) / 200.0
STRUCTURE = load_structure("configuration-1")
MARKERS = {marker.name: marker for marker in STRUCTURE.file.markers}
TARGET = 0.02 * np.sin(4.0 * np.pi * TIME)
FACES = [f"{body}-face" for body in STRUCTURE.body_names]


def column(lean, slip=(0.0, 0.0, 0.0), names=MARKERS):
    """Markers of blocks 1.6 m high that turn about their feet by ``lean`` [rad] and slip [m], with 0.1 mm of noise."""
    shape = np.sin(2.0 * np.pi * TIME) * (TIME > 0.5)
    foot = np.outer(TARGET * 1.02 + 0.002 * np.sin(9.0 * TIME), [1.0, 0.0, 0.0])
    poses = {"slab": (foot, Rotation.identity(len(TIME)))}
    for name, angle, slid in zip(STRUCTURE.body_names[1:], lean, slip, strict=True):
        turn = Rotation.from_rotvec(np.outer(shape, [0.0, angle, 0.0]))
        foot = foot + np.outer(shape, [slid, 0.0, 0.0])
        poses[name] = foot + turn.apply([0.0, 0.0, 0.8]), turn
        foot = foot + turn.apply([0.0, 0.0, 1.6])
    values = []
    for name in names:
        centre, turn = poses[MARKERS[name].body]
        place = centre + turn.apply(MARKERS[name].position)
        values.append(place - place[0])
    values = np.stack(values, axis=1) + np.random.default_rng(1).normal(
        0.0, 1e-4, (len(TIME), len(values), 3)
    )
    coordinates = {"time": TIME, "marker": list(names), "axis": list("xyz")}
    return xr.Dataset({"marker_displacement": (("time", "marker", "axis"), values)}, coordinates)


def exchanged(test, one, other):
    """The same readings under each other's name."""
    swap = {one: other, other: one}
    bodies = [next((body for body in swap if name.startswith(body)), "") for name in test["marker"].values]
    names = [
        name.replace(body, swap[body]) if body else name
        for name, body in zip(test["marker"].values, bodies, strict=True)
    ]
    return test.assign_coords(marker=names).sel(marker=test["marker"].values)


def remarks(test, target=TARGET):
    return exchange_remarks(test, STRUCTURE, Sensors(), target)


LEANS = {"together": (0.01, 0.01, 0.01), "the upper ones": (0.0, 0.01, 0.02), "an S": (0.01, -0.005, 0.01)}
PAIRS = [*itertools.combinations(STRUCTURE.body_names[1:], 2)]


@pytest.mark.parametrize("lean", LEANS.values(), ids=LEANS)
@pytest.mark.parametrize("slip", [(0.0, 0.0, 0.0), (0.0, 0.02, 0.0), (0.03, 0.0, -0.02)])
@pytest.mark.parametrize("names", [MARKERS, FACES], ids=["four markers", "one marker"])
def test_columns_as_they_are_make_no_remark(lean, slip, names):
    assert remarks(column(lean, slip, names)) == []


@pytest.mark.parametrize("lean", LEANS.values(), ids=LEANS)
@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_two_blocks_with_poses_are_named(lean, one, other):
    (remark,) = remarks(exchanged(column(lean), one, other))
    assert remark.startswith(f"{one} moves as {other} should, and {other} as {one}")


def test_blocks_with_one_marker_along_x_are_named_where_the_upper_one_moves_less():
    """Face of the lowest block at 0.8 m of a column that rocks, of the next one at 2.4 m: a third."""
    test = exchanged(column(LEANS["together"], names=FACES), "block-1", "block-2")
    test["marker_displacement"][..., 1:] = np.nan
    (remark,) = remarks(test)
    assert "block-1 moves as block-2 should" in remark
    assert "moves by 0.33 of the lower one" in remark


def test_a_block_that_follows_the_command_in_place_of_the_slab_is_named():
    found = remarks(exchanged(column(LEANS["together"], names=FACES), "slab", "block-3"))
    assert "block-3 follows the command more closely than slab: are their markers exchanged?" in found


def test_a_command_that_is_not_at_hand_makes_no_remark():
    assert remarks(column(LEANS["together"]), None) == []


def test_an_axis_of_a_block_that_is_reversed_is_named():
    test = column(LEANS["together"])
    mine = [name for name in MARKERS if name.startswith("block-2")]
    test["marker_displacement"].loc[{"marker": mine, "axis": "z"}] *= -1.0
    assert "the markers of block-2 move as on a rigid body with z reversed alone" in remarks(test)


def test_one_marker_of_each_of_two_blocks_that_are_exchanged_are_named():
    test = column(LEANS["together"])
    swap = {"block-1-upper": "block-2-upper", "block-2-upper": "block-1-upper"}
    found = remarks(test.assign_coords(marker=[swap.get(name, name) for name in test["marker"].values]))
    assert any(one.startswith("block-1-upper moves as block-2-upper should") for one in found)
