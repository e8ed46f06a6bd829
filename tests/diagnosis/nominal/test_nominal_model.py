"""Draws of the nominal model: the flatness of faces, which no drawing states."""

import numpy as np
from scipy.stats import kstest

from blockshake.diagnosis.nominal.nominal_model import draw_nominal, draw_twin
from blockshake.geometry.structure import load_structure
from blockshake.study.calibration.settings import HOLLOW, OTHERS

BLOCK = "shapes.block.hollow"
EDGE = 0.8  # m, the block's smallest
STRUCTURE = load_structure("configuration-1")


def _drawn(structure, model="ls-dem", count=200):
    return [draw_nominal(structure, model, number).parameters for number in range(count)]


def test_hollows_have_the_prior_of_the_calibration():
    shares = np.array([one[BLOCK] for one in _drawn(STRUCTURE)]) / EDGE
    assert kstest(OTHERS[HOLLOW].share(shares), "uniform").pvalue > 0.01


def test_a_driven_slab_and_models_without_a_use_have_none():
    assert {name for one in _drawn(STRUCTURE, count=3) for name in one if "hollow" in name} == {BLOCK}
    assert not any("hollow" in name for one in _drawn(STRUCTURE, "nscd-rigid", 3) for name in one)


def test_boxes_of_all_sizes_are_as_hollow_for_their_edges():
    one = draw_nominal(load_structure("configuration-4"), "ls-dem", 1).parameters
    assert one["shapes.beam.hollow"] / 0.2 == one[BLOCK] / EDGE


def test_a_stated_hollow_is_kept():
    stated = STRUCTURE.with_parameters({BLOCK: 1e-3})
    assert not any("hollow" in name for one in _drawn(stated, count=3) for name in one)


def test_other_parameters_are_drawn_before_it():
    """The draws of a structure that states its hollow are those of one that does not, but for the hollow."""
    stated = _drawn(STRUCTURE.with_parameters({BLOCK: 1e-3}), count=3)
    without = [
        {name: value for name, value in one.items() if name != BLOCK} for one in _drawn(STRUCTURE, count=3)
    ]
    assert stated == without


def test_twins_start_apart_by_less_than_sensors_resolve_and_are_read_with_the_same_noise():
    twins = [draw_twin(STRUCTURE, "ls-dem", number) for number in range(40)]
    first = draw_nominal(STRUCTURE, "ls-dem", 0)
    assert (twins[0].places == first.places).all()
    assert twins[0].amplitude == first.amplitude
    for twin in twins[1:]:
        assert (twin.seed, twin.noise, twin.parameters) == (first.seed, first.noise, first.parameters)
    assert twins[1].time_step == 0.5 * first.time_step
    apart = np.array([twin.places - first.places for twin in twins[1:]])
    assert not apart[:, STRUCTURE.driven].any()
    # standard error of a deviation of 117 values: 6.5 %; four of them
    spread = apart[:, ~STRUCTURE.driven].std(axis=(0, 1))
    np.testing.assert_allclose(spread, [2e-4, 2e-4, 1e-4], rtol=0.26)
