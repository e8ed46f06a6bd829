"""Displacement transducers against the markers of their bodies on prescribed motions, from readings to findings."""

import json

import numpy as np
import pytest
from synthetic_campaigns import make_tests, structure_of_three

from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.parity.correction import corrected
from blockshake.parity.parity import Parity, check_parity

WIRE_1 = {
    "name": "wire-1", "body": "block-1", "position": [-0.4, 0.0, 0.6],
    "reference": "slab", "reference_position": [-1.4, 0.0, 1.5],
}  # fmt: skip
WIRE_3 = {
    "name": "wire-3", "body": "block-3", "position": [-0.4, 0.3, 0.6],
    "reference": "slab", "reference_position": [-1.5, 0.3, 4.7],
}  # fmt: skip
ROD = {
    "name": "rod-2", "body": "block-2", "position": [0.4, 0.0, 0.0],
    "reference": "slab", "reference_position": [0.9, 0.0, 2.5], "axis": "-x",
}  # fmt: skip
TRANSDUCERS = [WIRE_1, WIRE_3, ROD]
CLEAN_CAMPAIGNS = 20


@pytest.fixture(scope="module")
def structure():
    return structure_of_three(transducers=TRANSDUCERS)


def mounted(seed, spread):
    """The structure with every end off its stated place by a standard deviation [m] along each axis."""
    generator = np.random.default_rng([seed, 8])
    ends = ("position", "reference_position")
    moved = [
        {**one, **{end: (one[end] + generator.normal(0.0, spread, 3)).tolist() for end in ends}}
        for one in TRANSDUCERS
    ]
    return structure_of_three(transducers=moved)


def test_sound_transducers_give_no_finding(structure):
    """Ends within 5 mm, markers within 1 mm of their places, coloured noise, gaps and outliers."""
    tests = make_tests(mounted(1, 1.5e-3), 1, mounting=1e-3, marker_dropouts=0.02, outliers=0.002)
    parity = check_parity(tests, structure, Sensors())
    assert parity.findings == ()
    assert parity.transducers["transducer"].values.tolist() == ["wire-1", "wire-3", "rod-2"]
    # made without any: an end within 5 mm, at turns of 16 mrad, is 0.08 mm of 20
    assert (np.abs(parity.transducers["gain"]) < 4.0 * parity.transducers["gain_error"]).all()
    assert (parity.transducers["gain_error"] < 5e-3).all()
    again = Parity.from_json(json.loads(json.dumps(parity.as_json())))
    np.testing.assert_array_equal(again.transducers["gain"], parity.transducers["gain"])
    assert again.recorder_sensors["wire-1"] == "transducer"
    assert again.recorder_sensors["slab-acc-x"] == "channel"


def test_each_fault_is_named_at_its_transducer_and_taken_out(structure):
    """A gain, a sign and a slip in one campaign whose optical clock is late: four findings and no more."""
    sound = make_tests(structure, 3, mounting=1e-3, marker_lag=5e-3)
    spoilt = {name: test.copy(deep=True) for name, test in sound.items()}
    for name, test in spoilt.items():
        wire_1, wire_3, rod = test["transducer_displacement"].values.T
        wire_1 *= 1.04
        rod *= -1.0
        if name == "t2":
            wire_3[test["time_acc"].to_numpy() > 5.05] += 2e-3
    parity = check_parity(spoilt, structure, Sensors())
    found = {(one.effect, one.where, one.quantity): one for one in parity.findings}
    assert set(found) == {
        ("clock-lag", ("optical clock",), "lag"),
        ("sensor-gain", ("wire-1",), "gain"),
        ("channel-swap", ("rod-2",), "polarity"),
        ("sensor-drift", ("wire-3",), "slip"),
    }
    gain, slip = found["sensor-gain", ("wire-1",), "gain"], found["sensor-drift", ("wire-3",), "slip"]
    assert abs(gain.estimate[0] - 0.04) < 4.0 * gain.standard_error[0]
    assert abs(slip.estimate[0] - 2e-3) < 4.0 * slip.standard_error[0]
    assert (slip.tests, slip.estimate[1]) == (("t2",), pytest.approx(5.05, abs=0.1))
    mended = corrected(spoilt["t2"], "t2", structure, parity.findings)["transducer_displacement"]
    error = np.abs(mended - sound["t2"]["transducer_displacement"].to_numpy()).max("time_acc").to_numpy()
    largest = np.abs(sound["t2"]["transducer_displacement"]).max("time_acc").to_numpy()
    assert error[0] < 4.0 * gain.standard_error[0] * largest[0]
    assert error[2] == 0.0
    # the step's time is known to a tenth of a second: with it nothing is left but the error of its size
    beside = np.abs(sound["t2"]["time_acc"].to_numpy() - 5.05) > 0.1
    left = (mended - sound["t2"]["transducer_displacement"].to_numpy()).to_numpy()[beside, 1]
    assert np.abs(left).max() < 4.0 * slip.standard_error[0]


def test_an_end_elsewhere_is_named_with_its_place(structure):
    moved = structure_of_three(transducers=[{**WIRE_1, "position": [-0.4, 0.0, 0.64]}, WIRE_3, ROD])
    parity = check_parity(make_tests(moved, 2, mounting=1e-3), structure, Sensors())
    assert [(one.effect, one.where, one.quantity) for one in parity.findings] == [
        ("marker-offset", ("wire-1",), "place")
    ]
    finding = parity.findings[0]
    assert abs(finding.estimate[2] - 0.04) < 4.0 * finding.standard_error[2]


def test_ends_that_the_markers_do_not_see_are_not_judged():
    """Markers on one face lie on a line: how its points turn about that line nobody knows."""
    structure = structure_of_three(face_markers_only=True, transducers=[WIRE_3])
    parity = check_parity(make_tests(structure, 4, mounting=1e-3), structure, Sensors())
    assert np.isnan(parity.transducers["gain"].sel(transducer="wire-3"))
    assert parity.findings == ()


@pytest.mark.slow
def test_false_alarms_of_clean_campaigns(structure):
    """At most 5 % of campaigns with faultless sensors get any finding; half the tolerance is a standard deviation."""
    alarms = 0
    for seed in range(CLEAN_CAMPAIGNS):
        generator = np.random.default_rng([seed, 99])
        tests = make_tests(
            mounted(seed, 2.5e-3 / np.sqrt(3.0)),
            3000 + seed,
            colour=generator.uniform(0.0, 0.5),
            mounting=1e-3,
            marker_dropouts=generator.uniform(0.0, 0.03),
            outliers=0.002 * (seed % 3 == 0),
            pitch=generator.uniform(1e-4, 6e-4) * (seed % 3 == 1),
        )
        alarms += bool(check_parity(tests, structure, Sensors()).findings)
    assert alarms <= 0.05 * CLEAN_CAMPAIGNS
