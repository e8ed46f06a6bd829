"""Slip that begins below the static friction speaks against friction that falls with the slip or its rate."""

import pytest
from simulated_tests import seen_tests

from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.forces.seen.wrench_histories import slips_early

MOTION = {"one": ("basso-tirreno", 2.0)}
UPPER = {"joint": ["block-1", "block-2"]}


def _seen(name, values, place):
    return seen_tests(
        "sliding-blocks", MOTION, change=lambda experiment, _: with_effect(experiment, name, values, place)
    )[0]


@pytest.mark.parametrize(
    ("name", "values", "place", "joint", "early"),
    [
        ("weak-joint", {"factor": 0.2}, UPPER, 1, True),
        ("weak-joint", {"factor": 1.0}, UPPER, 0, False),
        ("rate-weakening-friction", {"drop": 0.6, "scale": 0.003}, {}, 0, False),
        ("slip-weakening-friction", {"drop": 0.6, "scale": 0.01}, {}, 0, False),
    ],
)
def test_a_joint_without_friction_slips_early_and_one_that_loses_its_friction_does_not(
    name, values, place, joint, early
):
    seen = _seen(name, values, place)
    assert seen.states.slip[:, joint].any()
    assert slips_early(seen, joint) == early


def test_what_slips_early_makes_no_column_of_friction_that_falls():
    seen = _seen("weak-joint", {"factor": 0.2}, UPPER)
    for name in ("rate-weakening-friction", "slip-weakening-friction"):
        assert not any(columns.rows.any() for columns in EFFECTS[name].columns(seen, {}))
    assert any(columns.rows.any() for columns in EFFECTS["weak-joint"].columns(seen, UPPER))
