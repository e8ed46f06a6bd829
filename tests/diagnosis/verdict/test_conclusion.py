"""The verdict from sensors, decision and gain."""

import numpy as np
import pytest
from made_up_decision import made_up_decision, made_up_part

from blockshake.diagnosis.answer.decide import kind_of
from blockshake.diagnosis.answer.decision import Measurement
from blockshake.diagnosis.verdict.conclusion import conclude
from blockshake.diagnosis.verdict.verdict import Contrast, MeasuredGain
from blockshake.effects.registry import EFFECTS
from blockshake.parity.finding import Finding

KINDS = {"block-1-acc-x": "channel", "wire-1": "transducer"}


def _finding(effect="sensor-gain", where=("block-1-face",), quantity="gain", estimate=(0.03,), p=1e-4):
    estimate = np.array(estimate)
    return Finding(effect, where, quantity, estimate, np.eye(len(estimate)) * 1e-6, p, ("t1", "t2"))


def _verdict(decision, findings=()):
    return conclude(decision, findings, KINDS)


def test_nothing_found_says_what_would_have_been_seen():
    verdict = _verdict(made_up_decision())
    assert (verdict.decision, verdict.causes, verdict.misfit.p) == ("none", (), 1.0)
    assert verdict.excluded_above == {"table-pitch": 2e-4}
    assert verdict.next_test is None


def test_a_name_has_its_parameter_and_its_rivals():
    verdict = _verdict(made_up_decision("named", ("table-pitch",)))
    assert verdict.parameters["table-pitch"]["coefficient"].upper == 5e-4
    assert (verdict.odds, verdict.places) == ({"table-pitch": 0.0}, {"table-pitch": ("there",)})
    assert (verdict.excluded_above, verdict.location) == ({}, {})
    assert verdict.next_test == EFFECTS["table-pitch"].distinguished_by


@pytest.mark.parametrize(("lower", "proposed"), [(0.1, True), (0.0, False), (-0.4, False), (None, True)])
def test_a_cause_that_gains_nothing_on_the_tests_to_select_by_is_named_and_not_proposed(lower, proposed):
    select = None if lower is None else Contrast(estimate=0.3, lower=lower, upper=0.5)
    decision = made_up_decision("named", ("weak-joint",))
    verdict = conclude(decision, (), KINDS, measured=MeasuredGain(select=select))
    assert (verdict.decision, verdict.causes) == ("named", ("weak-joint",))
    assert verdict.extension == (decision.extending if proposed else ())
    assert any("is not proposed" in reason for reason in verdict.missing) != proposed


def test_a_joint_is_the_location():
    verdict = _verdict(made_up_decision("named", ("weak-joint",)))
    assert verdict.location == {"weak-joint": {"joint": ("slab", "block-1")}}


def test_a_sensor_fault_alone_is_named_with_its_marker():
    verdict = _verdict(made_up_decision(), [_finding()])
    assert (verdict.decision, verdict.causes) == ("named", ("sensor-gain",))
    estimate = verdict.parameters["sensor-gain"]["error"]
    # the error of reading, and a twentieth of the size for what a constant gain leaves out
    half = 1.645 * np.hypot(1e-3, 0.05 * 0.03)
    assert (estimate.estimate, estimate.upper) == (0.03, pytest.approx(0.03 + half))
    assert verdict.location["sensor-gain"] == {"marker": "block-1-face"}
    assert verdict.misfit.where == "readings of block-1-face, against the other sensors"
    assert verdict.misfit.p == 1e-4


@pytest.mark.parametrize(
    ("effect", "quantity", "size"),
    [("sensor-gain", "gain", 0.1), ("marker-offset", "place", 0.02), ("clock-lag", "skew", None)],
)
def test_the_size_of_a_vector_is_the_component_that_the_effect_has(effect, quantity, size):
    """A gain counts along x, the direction of shaking; a place by its height; a skew [1] is no lag [s]."""
    vector = (0.1, 0.0, 0.02) if size else (1e-3,)
    parameters = _verdict(
        made_up_decision(), [_finding(effect, quantity=quantity, estimate=vector)]
    ).parameters
    sizes = [one.estimate for one in parameters.get(effect, {}).values()]
    assert sizes == ([size] if size else [])


@pytest.mark.parametrize(
    ("where", "kind"), [("block-1-acc-x", "channel"), ("wire-1", "transducer"), ("block-1-face", "marker")]
)
def test_a_faulty_sensor_is_located_by_its_kind(where, kind):
    assert _verdict(made_up_decision(), [_finding(where=(where,))]).location["sensor-gain"] == {kind: where}


def test_a_sensor_fault_beside_a_cause_is_a_combination():
    verdict = _verdict(made_up_decision("named", ("weak-joint",)), [_finding()])
    assert (verdict.decision, verdict.causes) == ("combination", ("sensor-gain", "weak-joint"))


def test_a_form_from_outside_alone_is_unknown_and_described():
    verdict = _verdict(made_up_decision("unknown", ("push",)))
    assert (verdict.decision, verdict.causes) == ("unknown", ())
    assert (verdict.outside.form, verdict.outside.starts) == ("push", {"t1": 2.5})
    assert verdict.outside.size["force"].estimate == 4e3


def test_a_sensor_fault_beside_a_form_from_outside_is_a_combination_with_both():
    verdict = _verdict(made_up_decision("unknown", ("push",)), [_finding()])
    assert (verdict.decision, verdict.causes) == ("combination", ("sensor-gain",))
    assert verdict.location == {"sensor-gain": {"marker": "block-1-face"}}
    assert verdict.parameters["sensor-gain"]["error"].estimate == 0.03
    assert verdict.outside.form == "push"
    assert verdict.word == "probable"
    assert "a force from outside acts with it" in verdict.missing


def test_a_form_beside_an_effect_keeps_it_from_being_alone():
    verdict = _verdict(made_up_decision("ambiguous", ("weak-joint", "push")))
    assert (verdict.causes, verdict.outside.form) == (("weak-joint",), "push")
    assert any("do not tell these apart" in line for line in verdict.caveats)


def test_two_parts_are_a_combination_and_silent_tests_are_said():
    verdict = _verdict(made_up_decision("combination", ("weak-joint",), ("table-pitch",), silent=["t2"]))
    assert verdict.causes == ("weak-joint", "table-pitch")
    assert any("in t2" in line for line in verdict.caveats)


def test_measurements_that_split_a_set_stand_in_the_verdict_and_in_its_words():
    jack = {
        "between": ["weak-joint", "rate-weakening-friction"],
        "kind": "jack",
        "test": "push it",
        "share": 0.9,
    }
    decision = made_up_decision("ambiguous", ("weak-joint", "rate-weakening-friction"))
    (part,) = decision.parts
    told = part.model_copy(update={"next_tests": (Measurement.model_validate(jack),)})
    verdict = _verdict(decision.model_copy(update={"parts": (told,)}))
    assert [one.test for one in verdict.next_tests] == ["push it"]
    assert verdict.next_test == "push it (splits 90 % of such cases)"


def test_a_form_in_readings_of_its_own_beside_an_effect_is_a_combination():
    """It is a set only where both explain the same readings."""
    alone, beside = made_up_part("weak-joint"), made_up_part("push")
    assert kind_of([alone]) == "named"
    assert kind_of([beside]) == "unknown"
    assert kind_of([alone, beside]) == "combination"
    assert kind_of([made_up_part("weak-joint", "push")]) == "ambiguous"
