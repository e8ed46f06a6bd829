"""The oracle's model has the true causes in their own form, in the test of their own number."""

import numpy as np
import pytest
from choose_example import TrueEffect, candidates, table
from effect_forms import FORMS
from make_case import structure_file
from oracle_gain import TrueCauses

from blockshake.diagnosis.verdict.verdict import Contrast
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.virtual.truth import hidden_effect

ECCENTRIC = {"name": "eccentricity", "values": {"offset": 0.05}, "place": {"body": "block-1"}}
BLOW = {
    "name": "outside-blow", "place": {"body": "block-2"}, "start": [None, 2.0],
    "values": {"speed": 0.3, "length": 0.05, "height": 0.1, "side": 1.0},
}  # fmt: skip


@pytest.fixture
def plain():
    structure = load_structure(structure_file("two-blocks"))
    return Experiment(structure, load_motion("alkion", 2.0), Instruments())


@pytest.mark.parametrize("laboratory", ["home", "mujoco", "unusual"])
def test_an_effect_acts_in_the_form_of_its_laboratory(plain, laboratory):
    true = TrueCauses({"causes": [ECCENTRIC], "laboratory": laboratory}, 0)(plain)
    named = with_effect(plain, **ECCENTRIC)
    formed = FORMS["eccentricity"][1](plain, ECCENTRIC["values"], ECCENTRIC["place"])
    expected = named if laboratory == "mujoco" else formed
    assert np.array_equal(true.structure.mass_offset, expected.structure.mass_offset)
    assert not np.array_equal(named.structure.mass_offset, formed.structure.mass_offset)


def test_the_example_is_chosen_among_all_effects_that_act_by_the_surest_gain():
    every = list(candidates())
    acting = {name for name, effect in EFFECTS.items() if effect.acts != "observation"}
    assert {one.effect for one in every} == acting
    structure = load_structure("configuration-2")
    effects = [hidden_effect(one, structure, 1) for one in every[-2:]]
    gains = Contrast(estimate=0.9, lower=-0.1, upper=1.0), Contrast(estimate=0.5, lower=0.4, upper=0.6)
    *_, first, second = table(zip(effects, gains, strict=True)).splitlines()
    assert first == "| `weak-joint` | block-3-block-4 | 0.12 | 0.50 [0.40, 0.60] |"
    assert second.startswith("| `weak-joint` | block-2-block-3 |")
    assert table([(effects[0], None)]).endswith("| nothing to gain |")


def test_the_oracle_of_the_example_has_its_effect(plain):
    true = TrueEffect(ECCENTRIC)(plain)
    assert np.array_equal(true.structure.mass_offset, with_effect(plain, **ECCENTRIC).structure.mass_offset)
    assert TrueEffect(ECCENTRIC).digest != TrueEffect({**ECCENTRIC, "values": {"offset": 0.04}}).digest


def test_a_blow_acts_in_its_own_test_alone(plain):
    truth = {"causes": [BLOW], "laboratory": "home"}
    still, struck = (TrueCauses(truth, number) for number in (0, 1))
    assert not still(plain).structure.file.external_forces
    assert struck(plain).structure.file.external_forces
    assert still.digest != struck.digest
