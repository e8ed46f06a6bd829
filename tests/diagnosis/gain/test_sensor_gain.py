from types import SimpleNamespace

import numpy as np
import pytest
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, seen

from blockshake.diagnosis.gain import sensor_gain
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


@pytest.fixture
def gain(monkeypatch):
    """Gain with findings on a campaign of tests of which one marker reads too much by these shares."""

    def gained(findings, **tests):
        readings = {name: _test(share) for name, share in tests.items()}
        monkeypatch.setattr(sensor_gain, "load_structure", lambda _: STRUCTURE)
        monkeypatch.setattr(sensor_gain, "load_test", lambda _, name: readings[name])
        sealed = [name for name in tests if name != "open"]
        campaign = SimpleNamespace(structure="", sensors=SENSORS, sealed=sealed)
        return sensor_gain.sensor_gain(campaign, ["open"], findings)

    return gained


def test_a_right_estimate_gains_nearly_all_and_a_wrong_one_nothing(gain):
    found = gain([_finding(0.05)], open=0.05, one=0.05, two=0.05)
    right, scores = found.summary.gain, found.scores
    assert right.nominal.estimate == pytest.approx(1.0, abs=0.1)
    assert right.recalibrated == right.nominal
    assert right.discrepancy.estimate > 0.5
    assert scores["score"].sel(kind="extended").max() < scores["score"].sel(kind="nominal").min()
    assert gain([_finding(-0.05)], open=0.05, one=0.05).summary.gain.nominal.upper < 0.0


def test_what_does_not_hold_in_all_tests_has_no_gain(gain):
    drift = Finding("sensor-drift", (MARKER,), "drift", np.zeros(3), np.eye(3), 1e-9, ("open",))
    assert sensor_gain.gaining([drift, _finding(0.05)], STRUCTURE).effect == "sensor-gain"
    found = gain([drift], open=0.0)
    assert found.summary.gain is None
    assert not found.scores.data_vars
    assert "no gain" in found.summary.caveats[0]
