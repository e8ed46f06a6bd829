"""A campaign as a history: edges that wear from test to test are seen as a path, and sound or worn ones are silent."""

import pytest
from simulated_tests import seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.verdict.grade import grade
from blockshake.diagnosis.verdict.verdict import MeasuredGain
from blockshake.effects.registry import with_effect
from blockshake.measurement.campaigns.initial_poses import placed

MOTIONS = {
    "first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0), "third": ("alkion", 2.5), "fourth": ("alkion", 2.8),
}  # fmt: skip
WORN = {"first": 0.005, "second": 0.025, "third": 0.045, "fourth": 0.07}  # m, of the edges of all blocks


def _seen(insets):
    """Tests of two blocks whose edges lie further in by an amount of each test."""
    return seen_tests(
        "two-blocks", MOTIONS,
        change=lambda experiment, name: with_effect(experiment, "reduced-bearing", {"inset": insets[name]}, {}),
    )  # fmt: skip


@pytest.fixture(scope="module")
def worn():
    return decide(_seen(WORN)).decision


def _of_edges(decision):
    return next(one for one in decision.histories if one.parameter == "inset")


def test_edges_that_wear_from_test_to_test_are_a_path(worn):
    path = _of_edges(worn)
    assert path.changes
    assert path.tests == tuple(WORN)
    for size, true in zip(path.sizes, WORN.values(), strict=True):
        assert size.lower <= true <= size.upper
    middles = [size.estimate for size in path.sizes]
    assert middles == sorted(middles)


def test_the_model_is_extended_by_the_size_of_the_last_test(worn):
    cause = worn.parts[0].causes[0]
    last = _of_edges(worn).sizes[-1]
    assert cause.parameters["inset"] == last
    members = sorted(member["inset"] for member in cause.members)
    assert last.lower < members[len(members) // 2] < last.upper


@pytest.mark.slow
def test_edges_that_are_worn_alike_in_all_tests_have_no_path():
    decision = decide(_seen(dict.fromkeys(MOTIONS, 0.06))).decision
    assert [one.name for one in decision.causes] == ["reduced-bearing"]
    assert not any(one.changes for one in decision.histories)
    for size in _of_edges(decision).sizes:
        assert size.lower <= 0.06 <= size.upper


@pytest.mark.slow
def test_blocks_that_shift_from_test_to_test_are_a_path():
    shifts = dict(zip(MOTIONS, (0.0, 0.012, 0.024, 0.036), strict=True))  # m, of the upper block
    places = {name: [[0.0] * 3, [0.0] * 3, [shift, 0.0, 0.0]] for name, shift in shifts.items()}

    def change(experiment, name):
        return experiment.with_parameters(**placed(experiment.structure, places[name]))

    decision = decide(seen_tests("two-blocks", MOTIONS, change=change)).decision
    (path,) = [one for one in decision.histories if one.changes]
    assert (path.quantity, path.place, path.beats) == ("middle", {"joint": ["slab", "block-1"]}, "push")
    # of two blocks alike, the joint below both bears half as far off the other way
    for size, shift in zip(path.sizes, shifts.values(), strict=True):
        assert size.lower <= -0.5 * shift <= size.upper


@pytest.mark.slow
def test_friction_that_polishes_from_test_to_test_is_a_path_and_holds_back_a_cause_that_explains_less():
    motions = {
        "first": ("alkion", 2.0), "second": ("basso-tirreno", 2.0), "third": ("alkion", 2.5),
        "fourth": ("basso-tirreno", 2.3),
    }  # fmt: skip
    left = dict(zip(motions, (1.0, 0.9, 0.8, 0.7), strict=True))  # of the coefficient

    def polish(experiment, name):
        changed = {
            f"friction.{'.'.join(one.pair)}": left[name] * one.coefficient
            for one in experiment.structure.file.friction
        }
        return experiment.with_parameters(**changed)

    decision = decide(seen_tests("sliding-blocks", motions, change=polish)).decision
    (path,) = [one for one in decision.histories if one.changes]
    assert path.quantity == "friction"
    for size, share in zip(path.sizes, left.values(), strict=True):
        assert size.lower <= share - 1.0 <= size.upper
    middles = [size.estimate for size in path.sizes]
    assert middles == sorted(middles, reverse=True)
    assert path.beats == decision.parts[0].causes[0].name
    assert (
        "sizes that change from test to test explain more"
        in grade("named", decision, False, MeasuredGain()).missing
    )
