"""The lines in which a run ends: drift, lift and tilt of motions that are known, each by its own name."""

import numpy as np
import pytest
import xarray as xr

from blockshake.simulation.ending import ending
from blockshake.simulation.rocking import columns, overhangs
from blockshake.study.remarks import structure_remarks

TIME = np.linspace(0.0, 1.0, 5)  # s
TILT = 0.03  # rad


@pytest.fixture
def pair(make_structure):
    """Two cubes of 1 m on a slab, apart from each other along y."""
    return make_structure([
        {"name": "left", "shape": "cube", "position": [0.0, -1.0, 0.5]},
        {"name": "right", "shape": "cube", "position": [0.0, 1.0, 0.5]},
    ])  # fmt: skip


def run_of(structure, moved, tilt):
    """Run whose last body is moved (n_times, 3) [m] and tilts about y [rad] on a slab that travels by 5 m."""
    base = np.array([5.0, 0.0, 0.0]) * np.linspace(0.0, 1.0, len(TIME))[:, None, None]
    position = structure.position + base
    position[:, -1] += moved
    orientation = np.zeros((len(TIME), 3, 4))
    orientation[..., 0] = 1.0
    orientation[:, -1, 0], orientation[:, -1, 2] = np.cos(0.5 * tilt), np.sin(0.5 * tilt)
    return xr.Dataset(
        {
            "position": (("time", "body", "axis"), position),
            "orientation": (("time", "body", "quaternion"), orientation),
        },
        {"time": TIME},
        {"status": "completed", "reason": "", "end_time": 1.0},
    )


def test_a_drift_is_horizontal_and_a_lift_is_upwards(pair):
    moved = np.array([[0, 0, 0], [3e-3, 4e-3, 0], [1e-3, 0, 7e-3], [0, 0, -9e-3], [0, 0, 0]])
    assert ending(run_of(pair, moved, np.zeros(5)), pair) == [
        "no block fell in 1 s",
        "largest drift: 5 mm, right at 0.25 s (mass centre, horizontally against the base)",
        "largest lift: 7 mm, right at 0.5 s (mass centre, upwards)",
        "largest tilt: 0 mrad, left at 0 s",
        # of half a metre to the edge 4 mm are gone, along y
        "least margin against overturning: 99 %, joint slab-right (100 % at the start)",
    ]


@pytest.mark.parametrize(("largest", "rocks"), [(TILT, True), (1e-3, False)])
def test_a_block_that_rocks_is_one_whose_models_differ(largest, rocks, pair):
    tilt = np.array([0.0, 0.5, -1.0, 0.3, 0.0]) * largest
    lines = ending(run_of(pair, np.zeros((5, 3)), tilt), pair)
    assert f"largest tilt: {1e3 * largest:g} mrad, right at 0.5 s" in lines
    assert any(line.startswith("remark: blocks rock, ") for line in lines) == rocks


def test_a_fall_is_the_answer_with_its_reason(pair):
    """A cube that leans by 46 degrees has its weight beyond the edge."""
    run = run_of(pair, np.zeros((5, 3)), np.linspace(0.0, 0.8, 5))
    run.attrs |= {"status": "collapsed", "reason": "right tipped over", "end_time": 0.9}
    answer, *lines = ending(run, pair)
    assert answer == "collapsed at 0.9 s (right tipped over)"
    assert any("the weight went over the edge, joint slab-right" in line for line in lines)


def test_a_column_has_its_common_mass_centre_and_levers_to_both_sides(make_structure):
    """Two cubes, the upper one 0.1 m to the side and eccentric by 0.2 m: 0.15 m in all."""
    structure = make_structure([
        {"name": "lower", "shape": "cube", "position": [0.0, 0.0, 0.5]},
        {"name": "upper", "shape": "cube", "position": [0.1, 0.0, 1.5], "mass_offset": [0.2, 0.0, 0.0]},
    ])  # fmt: skip
    (column,) = columns(structure)
    assert column.bodies.tolist() == [1, 2]
    assert column.height == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(column.levers, [0.65, 0.35], atol=1e-9)


@pytest.mark.parametrize(("off", "is_remarked"), [(0.2, False), (0.24, False), (0.26, True), (0.4, True)])
def test_an_overhang_of_more_than_half_of_what_a_block_may_is_remarked(off, is_remarked, make_structure):
    """A cube of 1 m on another may stand 0.5 m off, where its mass centre is over the edge."""
    structure = make_structure([
        {"name": "lower", "shape": "cube", "position": [0.0, 0.0, 0.5]},
        {"name": "upper", "shape": "cube", "position": [0.0, off, 1.5]},
    ])  # fmt: skip
    assert overhangs(structure) == {2: pytest.approx(off / 0.5, abs=1e-9)}
    said = [remark for remark in structure_remarks(structure) if "overhangs" in remark]
    assert said == (
        [f"upper overhangs its support by {off / 0.5:.0%} of what it may alone"] if is_remarked else []
    )


def test_a_capital_that_overhangs_to_both_sides_and_a_lintel_have_no_overhang(make_structure):
    shapes = {"shaft": {"box": [0.4, 0.4, 1.0]}, "lintel": {"box": [3.0, 1.0, 0.5]}}
    capital = make_structure([
        {"name": "shaft", "shape": "shaft", "position": [0.0, 0.0, 0.5]},
        {"name": "capital", "shape": "cube", "position": [0.0, 0.0, 1.5]},
    ], shapes=shapes)  # fmt: skip
    lintel = make_structure([
        {"name": "left", "shape": "cube", "position": [-1.0, 0.0, 0.5]},
        {"name": "right", "shape": "cube", "position": [1.0, 0.0, 0.5]},
        {"name": "lintel", "shape": "lintel", "position": [0.0, 0.0, 1.25]},
    ], shapes=shapes)  # fmt: skip
    assert overhangs(capital) == overhangs(lintel) == {}
