"""Faultless sensors whose noise is not alike along all axes, or not white, have no fault."""

import pytest
from synthetic_campaigns import ROCKING, make_run, structure_of_three

from blockshake.measurement.sensors.found_noise import found_noise
from blockshake.measurement.sensors.instruments import Instruments, Sensors, SlowNoise, observe
from blockshake.parity.parity import check_parity

NOISES = {
    "depth": {"marker_axes": (1.0, 1.3, 1.0)},
    "depth, far worse": {"marker_axes": (1.0, 2.0, 0.8)},
    "slow": {"marker_slow": SlowNoise(share=0.3), "accelerometer_slow": SlowNoise(share=0.3)},
}


@pytest.fixture(scope="module")
def structure():
    return structure_of_three()


@pytest.fixture(scope="module")
def runs(structure):
    return {f"t{seed}": make_run(structure, peak, seed) for seed, peak in enumerate(ROCKING)}


def _findings(runs, structure, **instruments):
    tests = {
        name: observe(run, structure, Instruments(**instruments), seed)
        for seed, (name, run) in enumerate(runs.items())
    }
    return check_parity(tests, structure, found_noise(tests, structure, Sensors())).findings


@pytest.mark.parametrize("noise", list(NOISES))
def test_sound_sensors_have_no_fault(runs, structure, noise):
    assert _findings(runs, structure, **NOISES[noise]) == ()


def test_a_place_is_found_in_noise_that_is_uneven(runs, structure):
    (finding,) = _findings(
        runs, structure, marker_offset={"block-3-face": (0.0, 0.0, 0.04)}, marker_axes=(1.0, 1.5, 1.0)
    )
    assert (finding.quantity, finding.where) == ("place", ("block-3-face",))
    assert finding.estimate[2] == pytest.approx(0.04, abs=4.0 * finding.standard_error[2])
