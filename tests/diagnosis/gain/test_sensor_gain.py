import numpy as np
import pytest
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, seen

from blockshake.diagnosis.gain.sensor_gain import gaining, sensor_gain
from blockshake.parity.finding import Finding

BODY = next(
    body.name
    for body in STRUCTURE.file.bodies
    if not body.driven and sum(m.body == body.name for m in STRUCTURE.file.markers) >= 3
)
MARKER = next(m.name for m in STRUCTURE.file.markers if m.body == BODY)


def _test(gain):
    """A test in which one marker reads ``1 + gain`` times its displacement."""
    test = seen(moved_run(base_motion(), rocking=[bump(TIME, 2.0, 0.5, 0.02), 0.0]))
    test["marker_displacement"].loc[{"marker": MARKER}] *= 1.0 + gain
    return test


def _finding(gain):
    return Finding("sensor-gain", (MARKER,), "gain", np.array([gain]), np.eye(1) * 1e-8, 1e-6, ("open",))


def test_a_right_estimate_gains_nearly_all_and_a_wrong_one_nothing():
    opened, sealed = {"open": _test(0.05)}, {"one": _test(0.05), "two": _test(0.05)}
    found = sensor_gain(_finding(0.05), opened, sealed, STRUCTURE, SENSORS)
    right, scores = found.summary.gain, found.scores
    assert right.nominal.estimate == pytest.approx(1.0, abs=0.1)
    assert right.recalibrated == right.nominal
    assert right.discrepancy.estimate > 0.5
    assert scores["score"].sel(kind="extended").max() < scores["score"].sel(kind="nominal").min()
    wrong = sensor_gain(_finding(-0.05), opened, sealed, STRUCTURE, SENSORS).summary.gain
    assert wrong.nominal.upper < 0.0


def test_what_does_not_hold_in_all_tests_has_no_gain():
    drift = Finding("sensor-drift", (MARKER,), "drift", np.zeros(3), np.eye(3), 1e-9, ("open",))
    assert gaining([drift], STRUCTURE) is None
    assert gaining([drift, _finding(0.05)], STRUCTURE).effect == "sensor-gain"
    found = sensor_gain(None, {}, {}, STRUCTURE, SENSORS)
    assert found.summary.gain is None
    assert not found.scores.data_vars
    assert "no gain" in found.summary.caveats[0]
