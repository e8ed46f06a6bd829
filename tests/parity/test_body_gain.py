"""A gain of all markers of one body, which no rigid fit shows, in readings whose motion is known."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "forces"))
from known_blocks import readings, shaken, sliding, stack

from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.parity.correction import corrected
from blockshake.parity.finding import Level
from blockshake.parity.kinds.body_gain import body_gains

SENSORS = Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
LEVEL = Level(0.01, 100)


def carried(t):
    """All bodies of a stack of three go with the table."""
    found = np.zeros((4, 3))
    found[:, 0] = shaken(2.0)(t)
    return found


@pytest.fixture(scope="module")
def sound():
    structure = stack(3)
    return structure, {name: readings(structure, carried, 1e-4, 0.02, seed) for seed, name in enumerate("ab")}


def gained(tests, body, gain):
    """Tests whose markers of a body read too much along x."""
    found = {}
    for name, test in tests.items():
        factor = np.array([1.0 + gain * str(marker).startswith(body) for marker in test["marker"].values])
        moved = test["marker_displacement"].copy()
        moved.loc[{"axis": "x"}] = moved.sel(axis="x") * factor
        found[name] = test.assign(marker_displacement=moved)
    return found


def test_sound_markers_have_no_gain(sound):
    structure, tests = sound
    assert body_gains(structure, tests, SENSORS, LEVEL) == []


@pytest.mark.parametrize("gain", [0.08, -0.05])
@pytest.mark.parametrize("body", ["block-1", "block-2", "block-3"])
def test_a_gain_of_a_body_is_found_by_its_joints_and_taken_out(sound, body, gain):
    structure, tests = sound
    spoilt = gained(tests, body, gain)
    (found,) = body_gains(structure, spoilt, SENSORS, LEVEL)
    assert (found.effect, found.quantity) == ("sensor-gain", "gain")
    assert all(name.startswith(body) for name in found.where)
    assert found.estimate[0] == pytest.approx(gain, abs=4.0 * found.standard_error[0] + 1e-3)
    for name, test in spoilt.items():
        left = (
            corrected(test, name, structure, [found])["marker_displacement"]
            - tests[name]["marker_displacement"]
        )
        assert np.abs(left).max() < 0.05 * abs(gain) * np.abs(tests[name]["marker_displacement"]).max()


def test_a_block_that_slides_has_no_gain():
    structure = stack(1, friction=0.2)
    tests = {"a": readings(structure, sliding(shaken(4.0), 0.2), 1e-4, 0.02)}
    assert body_gains(structure, tests, SENSORS, LEVEL) == []
