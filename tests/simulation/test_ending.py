"""The lines in which a run ends: drift, lift and lean of motions that are known, each by its own name."""

import numpy as np
import pytest
import xarray as xr

from blockshake.simulation.ending import ending
from blockshake.simulation.rocking import columns, overhangs
from blockshake.study.remarks import structure_remarks

TIME = np.linspace(0.0, 1.0, 5)  # s
LEAN = 0.03  # rad


@pytest.fixture
def pair(make_structure):
    """Two cubes of 1 m on a slab, apart from each other along y."""
    return make_structure([
        {"name": "left", "shape": "cube", "position": [0.0, -1.0, 0.5]},
        {"name": "right", "shape": "cube", "position": [0.0, 1.0, 0.5]},
    ])  # fmt: skip


def run_of(structure, moved, lean):
    """Run whose last body is moved (n_times, 3) [m] and leans about y [rad] on a slab that travels by 5 m."""
    base = np.array([5.0, 0.0, 0.0]) * np.linspace(0.0, 1.0, len(TIME))[:, None, None]
    position = structure.position + base
    position[:, -1] += moved
    orientation = np.zeros((len(TIME), 3, 4))
    orientation[..., 0] = 1.0
    orientation[:, -1, 0], orientation[:, -1, 2] = np.cos(0.5 * lean), np.sin(0.5 * lean)
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
    words, remark = ending(run_of(pair, moved, np.zeros(5)), pair)
    assert words == (
        "completed at 1 s; largest drift 5 mm at 0.25 s, of the mass centre of right horizontally against the base; "
        "largest lift 7 mm at 0.5 s, of the mass centre of right upwards"
    )
    assert remark == ""


@pytest.mark.parametrize(("largest", "is_remarked"), [(LEAN, True), (1e-3, False)])
def test_a_block_that_rocks_is_one_whose_models_differ(largest, is_remarked, pair):
    lean = np.array([0.0, 0.5, -1.0, 0.3, 0.0]) * largest
    _, remark = ending(run_of(pair, np.zeros((5, 3)), lean), pair)
    assert remark.startswith("right leans by up to 30 mrad: ") == is_remarked
    assert ("differ in rocking (docs/theory/rocking.md)" in remark) == is_remarked


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
