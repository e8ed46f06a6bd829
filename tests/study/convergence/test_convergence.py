"""Readings of a convergence study from its runs, and the orders that are known."""

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.store import Store
from blockshake.study.convergence.convergence import study_convergence
from blockshake.study.convergence.runs import rocking_block, shaken_stack
from blockshake.study.convergence.settings import Convergence
from blockshake.study.convergence.table import (
    COLUMNS,
    EXACT,
    OBSERVABLES,
    load_convergence,
    write_convergence,
)

G = 9.81
TINY = Convergence(
    structure="configuration-1",
    acceleration=2.5,
    frequency=5.0,
    duration=0.25,
    time_steps=(1e-4, 5e-5),
    node_spacings=(0.4, 0.8),
    perimeter_insets=(0.006, 0.003),
    grid_spacings=(0.1,),
)


@pytest.fixture(scope="module")
def said():
    return []


@pytest.fixture(scope="module")
def table(said, tmp_path_factory):
    return study_convergence(TINY, Store(tmp_path_factory.mktemp("store"), "source", said.append))


def test_table_has_a_row_for_every_setting_and_observable(table, said):
    assert tuple(table.columns) == COLUMNS
    settings = table.groupby("parameter", sort=False)["setting"].agg(lambda one: sorted(set(one)))
    assert settings.to_dict() == {
        "time_step": [5e-5, 1e-4],
        "node_spacing": [0.4, 0.8],
        "perimeter_inset": [0.003, 0.006],
        "grid_spacing": [EXACT, 0.1],
    }
    assert len(table) == 8 * len(OBSERVABLES)
    usual = table[table["usual"]].drop_duplicates(["parameter", "setting"])
    assert dict(zip(usual["parameter"], usual["setting"], strict=True)) == {
        "perimeter_inset": 0.003,
        "grid_spacing": EXACT,
    }
    # a line for each pair of runs, with its cost; the default inset is that of the reference, which is made once
    assert len(said) == 8
    assert all(line.endswith("CPU s") for line in said)


def test_differences_are_from_the_smallest_setting(table):
    for _, rows in table.groupby(["parameter", "observable"]):
        finest = rows.loc[rows["setting"].idxmin(), "value"]
        np.testing.assert_array_equal(rows["difference"], rows["value"] - finest)


def test_what_is_the_same_run_has_the_same_numbers(table):
    by = table.set_index(["parameter", "setting", "observable"])["value"]
    for name in OBSERVABLES:
        np.testing.assert_array_equal(by["perimeter_inset", 0.003, name], by["grid_spacing", EXACT, name])


def test_floor_is_that_of_one_part_in_a_million(table):
    """Shaking and a kick larger by 1e-6 change what goes with them by about so much, and the sink by nothing."""
    floor = table.drop_duplicates("observable").set_index("observable")
    assert floor["floor"]["sink"] == 0.0
    # the swing's time goes nearly with the kick; a quantity of no more than twice the second power of it
    assert 0.3e-6 < floor["floor"]["swing_time"] / floor["value"]["swing_time"] < 4e-6


def test_file_gives_the_table_back_with_the_same_bytes(table, tmp_path):
    path, again = tmp_path / "one.csv", tmp_path / "two.csv"
    write_convergence(path, table)
    loaded = load_convergence(path)
    assert loaded["parameter"].tolist() == table["parameter"].tolist()
    np.testing.assert_allclose(loaded["value"], table["value"], rtol=1e-15, atol=0.0)
    assert loaded["usual"].tolist() == table["usual"].tolist()
    write_convergence(again, table.copy())
    assert path.read_bytes() == again.read_bytes()
    path.write_text("parameter,setting\ntime_step,1e-5\n")
    with pytest.raises(InputError, match="columns"):
        load_convergence(path)


def test_sink_is_the_weight_above_on_the_joints(table):
    """Three joints carry 3, 2 and 1 blocks on 2.16e10 N/m3 times the flat's area: 10.7 um at the top.

    The slab's nodes count for half of the lowest joint, which may be 0.90 to 1.04 as stiff (docs/method.md);
    so the sink may be as much as a twentieth larger or a fiftieth smaller.
    """
    stack = load_structure("configuration-1")
    area = (0.8 - 0.04) * (2.4 - 0.04)
    expected = 6.0 * stack.mass[1] * G / (2.16e10 * area)
    by = table.set_index(["parameter", "setting", "observable"])["value"]
    assert 0.98 * expected < by["grid_spacing", EXACT, "sink"] < 1.06 * expected


def test_swing_and_impact_are_those_of_a_rigid_block():
    """Rigid rocking: energy gives the time of the swing, a quadrature; the impact lies between Housner's and none.

    The kick is one about the block's edge; the pivot is the outermost node, 22 mm inside. There the kick's angular
    momentum about it is kept, so that the block starts 0.9 % faster.
    """
    parameters = LsDemParameters()
    read = rocking_block(load_structure("configuration-1"), "ls-dem", parameters, 2e-5, 1.0)
    half, edge = 0.8, 0.4
    pivot = (edge - 0.02) * (1.0 - 2.0 * parameters.perimeter_inset)
    central, radius = (0.8**2 + 1.6**2) / 12.0, np.hypot(half, pivot)
    inertia, alpha = central + radius**2, np.arctan(pivot / half)  # of a unit mass
    p2 = G * radius / inertia
    speed = 0.5 * (central + half**2 + edge * pivot) / inertia
    turned = alpha - np.arccos(np.cos(alpha) + speed**2 / (2.0 * p2))
    # theta = turned (1 - s^2) takes the root out of the turning point
    s = (np.arange(4000) + 0.5) / 4000
    left = speed**2 - 2.0 * p2 * (np.cos(alpha - turned * (1.0 - s**2)) - np.cos(alpha))
    expected = 2.0 * np.mean(2.0 * turned * s / np.sqrt(left))
    # without its chamfers' corners the block has 0.1 % less inertia than the sharp one
    assert read["swing_time"] == pytest.approx(expected, rel=2e-3)
    assert 1.0 - 2.0 * pivot**2 / inertia < read["impact_ratio"] < 1.0


def test_order_in_the_time_step_is_two_where_nothing_opens():
    """A stack that is shaken too weakly to rock sways as a linear chain: its error goes with the step squared."""
    stack, parameters = load_structure("configuration-1"), LsDemParameters()
    found = {}
    for step in (1e-5, 5e-5, 1e-4):
        found[step] = shaken_stack(stack, parameters, step, 0.2, 20.0, 0.1)
    errors = [found[step]["energy_residual"] for step in (5e-5, 1e-4)]
    assert np.log2(errors[1] / errors[0]) == pytest.approx(2.0, abs=0.1)
    # what the finest run is off by itself takes 1 from each square: (100 - 1) / (25 - 1)
    off = [found[step]["peak_drift"] - found[1e-5]["peak_drift"] for step in (5e-5, 1e-4)]
    assert off[1] / off[0] == pytest.approx(99.0 / 24.0, rel=0.05)


def test_block_without_a_base_is_refused(make_structure):
    flying = make_structure([{"name": "b", "shape": "cube", "position": [0.0, 0.0, 2.0]}])
    with pytest.raises(InputError, match="stands on a driven one"):
        rocking_block(flying, "ls-dem", LsDemParameters(), 1e-4, 1.0)


def test_stack_that_falls_has_a_sink_and_nothing_else():
    read = shaken_stack(load_structure("configuration-1"), LsDemParameters(), 1e-4, 6.0, 0.8, 3.0)
    assert read.pop("sink") > 0.0
    assert np.isnan(list(read.values())).all()
