"""Gain on the rows of a sealed test: a cause that is there explains them, one that is not explains nothing."""

import pytest
from made_up_decision import part_of
from simulated_tests import cause_of, seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.gain.row_gain import NO_ROWS, row_gain

OPEN = {"first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0)}
SEALED = {"third": ("alkion", 3.0)}
ROPE = cause_of("rope", {"body": "block-2", "height": 0.42}, {"stiffness": 2e5})


def test_a_rope_explains_most_of_what_sound_blocks_leave():
    opened, sealed = (seen_tests("two-blocks", motions, ROPE) for motions in (OPEN, SEALED))
    decision = decide(opened).decision
    gain, caveats = row_gain(decision, opened, sealed)
    assert decision.extending[0].name == "rope"
    assert (gain.recalibrated.estimate > 0.8, gain.recalibrated.lower > 0.5) == (True, True)
    assert caveats == []


@pytest.fixture(scope="module")
def sound():
    return [seen_tests("two-blocks", motions) for motions in (OPEN, SEALED)]


def _with(decision, cause):
    return decision.model_copy(update={"parts": (part_of(cause),)})


def test_a_cause_that_is_not_there_gains_nothing(sound):
    decision = decide(sound[0]).decision
    placebo = ROPE.model_copy(update={"amplitudes": (5e3,)})
    gain, _ = row_gain(_with(decision, placebo), *sound)
    # the nominal model alone has no edges and coefficients that fit the open tests
    assert max(gain.recalibrated.estimate, gain.discrepancy.estimate) <= 0.05


def test_a_blow_says_nothing_of_tests_to_come(sound):
    decision = decide(sound[0]).decision
    blow = cause_of("blow", ROPE.place, {"impulse": 1.0}, {"blows": {"first": {"time": 1.0, "width": 0.1}}})
    gain, caveats = row_gain(_with(decision, blow.model_copy(update={"amplitudes": (1.0,)})), *sound)
    assert (gain, caveats) == (None, [NO_ROWS])
