import numpy as np
import pytest
from made_up_decision import made_up_decision

from blockshake.diagnosis.inference.decision import CauseSize
from blockshake.diagnosis.verdict.conclusion import Judged, conclude
from blockshake.diagnosis.verdict.ladder import PROBABLE
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.effects.registry import EFFECTS
from blockshake.parity.finding import Finding

JUDGED = Judged("rotation of slab-block-1, before the first onset, to both sides", 3)


def _finding(effect="sensor-gain", where=("block-1-face",), quantity="gain", estimate=(0.03,), p=1e-4):
    estimate = np.array(estimate)
    return Finding(effect, where, quantity, estimate, np.eye(len(estimate)) * 1e-6, p, ("t1", "t2"))


def _verdict(decision, findings=(), effort="standard"):
    return conclude(
        decision, findings, {"block-1-acc-x": "channel", "wire-1": "transducer"}, JUDGED, 100, [], effort
    )


def test_nothing_found_says_what_would_have_been_seen():
    verdict = _verdict(made_up_decision())
    assert verdict.decision == "none"
    first = EFFECTS["table-pitch"].parameters[0]
    assert verdict.excluded_above == {"table-pitch": pytest.approx(0.5 * first.visible)}
    assert verdict.next_test is None


def test_a_name_has_its_parameter_and_what_is_not_informed_is_said():
    verdict = _verdict(made_up_decision("named", ["table-pitch"]))
    assert verdict.parameters["table-pitch"]["coefficient"].upper == 5e-4
    assert any("frequency not informed" in caveat for caveat in verdict.caveats)
    assert verdict.excluded_above == {}
    assert verdict.next_test == EFFECTS["table-pitch"].told_apart_by


def test_a_sensor_fault_alone_is_named_with_its_marker():
    verdict = _verdict(made_up_decision(), [_finding()])
    assert (verdict.decision, verdict.causes) == ("named", ("sensor-gain",))
    estimate = verdict.parameters["sensor-gain"]["error"]
    # the error of reading, and a twentieth of the size for what a constant gain leaves out
    half = 1.645 * np.hypot(1e-3, 0.05 * 0.03)
    assert (estimate.estimate, estimate.upper) == (0.03, pytest.approx(0.03 + half))
    assert verdict.location["sensor-gain"] == {"marker": "block-1-face"}
    assert (verdict.misfit.p, verdict.misfit.where) == (
        1e-4,
        "readings of block-1-face, against the other sensors",
    )


@pytest.mark.parametrize(("sensor", "kind"), [("block-1-acc-x", "channel"), ("wire-1", "transducer")])
def test_a_sensor_of_the_recorder_is_not_called_a_marker(sensor, kind):
    verdict = _verdict(made_up_decision(), [_finding(where=(sensor,))])
    assert verdict.location["sensor-gain"] == {kind: sensor}
    assert verdict.misfit.where == f"readings of {sensor}, against the other sensors"


def test_the_size_from_all_draws_with_the_cause_takes_the_place_of_the_decision_s():
    refined = {"estimate": 4.2e-4, "lower": 4e-4, "upper": 4.4e-4, "unit": "rad s2/m", "informed": True}
    size = CauseSize(
        key="table-pitch", sizes=(), posterior=(), error=0.1, draws=18, parameters={"coefficient": refined}
    )
    verdict = conclude(made_up_decision("named", ["table-pitch"]), (), {}, JUDGED, 100, [], "standard", size)
    assert verdict.parameters["table-pitch"]["coefficient"].lower == 4e-4


def test_a_sensor_fault_beside_a_physical_cause_is_a_combination():
    verdict = _verdict(made_up_decision("named", ["weak-joint"]), [_finding()])
    assert verdict.decision == "combination"
    assert verdict.causes == ("sensor-gain", "weak-joint")
    assert verdict.location["weak-joint"] == {"joint": ("slab", "block-1")}


def test_findings_of_one_name_are_one_cause():
    findings = [_finding(p=1e-3), _finding(where=("block-2-face",), p=1e-6)]
    verdict = _verdict(made_up_decision(), findings)
    assert verdict.causes == ("sensor-gain",)
    assert verdict.location["sensor-gain"] == {"marker": "block-2-face"}


def test_an_unknown_cause_stays_unknown_beside_a_sensor_fault():
    decision = made_up_decision("unknown")
    verdict = _verdict(decision, [_finding(p=0.1 * decision.p_none)])
    assert (verdict.decision, verdict.causes) == ("unknown", ())
    # of the corrected readings: the fault of the sensor is not the misfit
    assert (verdict.misfit.p, verdict.misfit.where) == (decision.p_none, JUDGED.where)
    assert any(EFFECTS["sensor-gain"].title in caveat for caveat in verdict.caveats)


def test_the_gain_of_a_sensor_fault_is_none_of_an_unknown_cause():
    one = Contrast(estimate=0.9, lower=0.8, upper=1.0)
    measured = MeasuredGain(gain=Gain(recalibrated=one, nominal=one, discrepancy=one), caveats=(), runs=0)

    def verdict(decision):
        return conclude(decision, [_finding()], {}, JUDGED, 100, [], "standard", measured=measured)

    unknown = verdict(made_up_decision("unknown"))
    assert unknown.gain is None
    assert any("no gain was measured" in caveat for caveat in unknown.caveats)
    # of the fault alone it is
    assert verdict(made_up_decision()).gain.nominal == one


def test_little_effort_allows_no_strong_word():
    verdict = _verdict(made_up_decision("named", ["table-pitch"]), effort="quick")
    assert any("probable" in caveat for caveat in verdict.caveats)
    assert verdict.word == PROBABLE
    assert "the effort was quick" in verdict.missing
