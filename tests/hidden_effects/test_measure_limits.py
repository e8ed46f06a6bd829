"""Causes that are hidden to try the limits of a plan."""

import pytest
from make_case import structure_file
from measure_limits import planned_causes

from blockshake.geometry.structure import load_structure

PLAN = {
    "effects": {
        "eccentricity": {"place": "block-2", "limits": {"block-1": 0.02, "block-2": 0.03}},
        "stopper-contact": {"place": "block-1@0.5", "limits": {"block-1@0.5": 4e5}},
        "weak-joint": {"place": "slab-block-1", "limits": {"slab-block-1": 0.4}},
        "table-pitch": {"place": "all", "limits": {"all": 4e-5}},
        "reduced-bearing": {"place": "slab-block-1", "limits": {"slab-block-1": None}},
    }
}


def test_a_cause_has_a_share_of_its_limit_from_the_null_value_at_its_place():
    half = {
        one["name"]: one for one in planned_causes(PLAN, load_structure(structure_file("two-blocks")), 0.5)
    }
    assert half["eccentricity"]["values"] == {"offset": pytest.approx(0.015)}
    assert half["eccentricity"]["place"] == {"body": "block-2"}
    assert half["weak-joint"]["values"]["factor"] == pytest.approx(0.7)
    assert half["weak-joint"]["place"] == {"joint": ["slab", "block-1"]}
    assert half["stopper-contact"]["place"]["body"] == "block-1"
    assert half["stopper-contact"]["values"]["gap"] == 0.02
    assert half["table-pitch"]["place"] == {}
    assert "reduced-bearing" not in half
