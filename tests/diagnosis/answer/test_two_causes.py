"""Two causes at once, in the joints or in the joints and a sensor: both are in the answer."""

import pytest
from simulated_tests import cause_of, read_tests, seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.gain.extended_model import extended_experiment
from blockshake.diagnosis.verdict.conclusion import conclude
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.parity.correction import corrected
from blockshake.parity.parity import check_parity

MOTIONS = {"first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0), "third": ("alkion", 3.0)}
STARTS = {"first": 2.5, "second": 2.0, "third": 3.0}  # s, of a push
TOP = {"body": "block-2", "height": 0.42}
MARKER = "block-2-upper"
WITHIN = 0.25  # of the size, as of one cause: the discretisation is not the columns'


def test_an_eccentric_block_on_narrow_bearings_is_answered_by_both():
    eccentric = cause_of("eccentricity", {"body": "block-2"}, {"offset": 0.08})
    narrow = cause_of("reduced-bearing", {}, {"inset": 0.08})
    tests = seen_tests(
        "two-blocks",
        MOTIONS,
        eccentric,
        lambda experiment, name: extended_experiment(experiment, narrow, 0, name),
    )
    decision = decide(tests).decision
    assert decision.decision == "combination"
    found = {cause.name: next(iter(cause.parameters.values())) for cause in decision.causes}
    assert set(found) == {"eccentricity", "reduced-bearing"}
    assert all(size.estimate == pytest.approx(0.08, rel=WITHIN) for size in found.values())


def test_a_sensors_fault_beside_a_force_from_outside_is_answered_by_both():
    push = cause_of("push", TOP, {"force": 6000.0}, {"starts": STARTS})
    gain = Instruments(marker_gain={MARKER: 0.93})
    structure, readings = read_tests("two-blocks", MOTIONS, push, noise=gain)
    findings = check_parity(readings, structure, Sensors()).findings
    assert [finding.where for finding in findings] == [(MARKER,)]  # no gain of its body, whose pose it moves
    seen = [
        reconstruct_test(name, corrected(test, name, structure, findings), structure, Sensors())
        for name, test in readings.items()
    ]
    verdict = conclude(decide(seen).decision, findings, {})
    assert (verdict.decision, verdict.causes) == ("combination", ("sensor-gain",))
    assert verdict.outside.form == "push"
    assert verdict.location["sensor-gain"] == {"marker": MARKER}
