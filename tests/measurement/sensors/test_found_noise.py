"""The noise that the rest before the tests shows: its size by axis, and its slow part."""

import numpy as np
import pytest
from synthetic_campaigns import make_run, structure_of_three

from blockshake.measurement.sensors.found_noise import found_noise
from blockshake.measurement.sensors.instruments import Instruments, Sensors, SlowNoise, observe


@pytest.fixture(scope="module")
def structure():
    return structure_of_three()


@pytest.fixture(scope="module")
def runs(structure):
    return [make_run(structure, 8e-3, seed) for seed in (1, 2, 3)]


def _found(runs, structure, change=None, **noise):
    instruments = Instruments(marker_noise=1.2e-4, accelerometer_noise=0.03, **noise)
    tests = {str(seed): observe(run, structure, instruments, seed) for seed, run in enumerate(runs)}
    if change:
        for test in tests.values():
            change(test)
    return found_noise(tests, structure, Sensors())


def test_white_noise_is_found_as_large_as_it_is_and_white(runs, structure):
    found = _found(runs, structure)
    np.testing.assert_allclose(found.noise_by_axis, 1.2e-4, rtol=0.05)
    assert found.accelerometer_noise == pytest.approx(0.03, rel=0.05)
    assert found.marker_slow.share == found.accelerometer_slow.share == 0.0


@pytest.mark.parametrize("share", [0.2, 0.5])
def test_a_slow_part_is_found_with_its_share_and_memory(runs, structure, share):
    slow = SlowNoise(share=share, memory=0.1)
    found = _found(runs, structure, marker_slow=slow, accelerometer_slow=slow)
    for one in (found.marker_slow, found.accelerometer_slow):
        assert one.share == pytest.approx(share, abs=0.16)
        assert 0.05 <= one.memory <= 0.2
    assert found.accelerometer_noise == pytest.approx(0.03, rel=0.1)


def test_noise_along_one_axis_is_found_along_it(runs, structure):
    found = _found(runs, structure, marker_axes=(1.0, 1.6, 1.0))
    np.testing.assert_allclose(found.noise_by_axis, [1.2e-4, 1.92e-4, 1.2e-4], rtol=0.06)


def test_blocks_that_settle_in_the_rest_make_no_axis_noisier(runs, structure):
    """Each block sinks on its own, by 0.3 mm in tenths of a second: the rest alone made z 1.2 times as noisy."""

    def settle(test):
        sinking = 3e-4 * np.exp(-test["time"].to_numpy() / 0.1)
        for number, block in enumerate(("block-1", "block-2", "block-3"), start=1):
            markers = [str(name) for name in test["marker"].values if str(name).startswith(block)]
            test["marker_displacement"].loc[{"axis": "z", "marker": markers}] += number * sinking[:, None]

    found = _found(runs, structure, settle)
    np.testing.assert_allclose(found.marker_axes, 1.0, rtol=0.03)


def test_a_table_that_creeps_in_the_rest_is_no_noise(runs, structure):
    """0.4 mm in half a second, by which the whole stack goes along."""

    def creep(test):
        time, time_acc = test["time"].to_numpy(), test["time_acc"].to_numpy()
        test["marker_displacement"].loc[{"axis": "x"}] += (2e-4 * (1.0 - np.cos(6.0 * time)))[:, None]
        along = [str(name) for name in test["channel"].values if str(name).endswith("-x")]
        test["accelerometer"].loc[{"channel": along}] += (0.05 * np.sin(20.0 * time_acc))[:, None]

    found = _found(runs, structure, creep)
    np.testing.assert_allclose(found.noise_by_axis, 1.2e-4, rtol=0.05)
    assert found.accelerometer_noise == pytest.approx(0.03, rel=0.05)
    assert found.marker_slow.share == found.accelerometer_slow.share == 0.0


def test_readings_that_do_not_move_at_all_keep_half_the_stated_noise(runs, structure):
    silent = Instruments(marker_noise=0.0, accelerometer_noise=0.0)
    found = found_noise({"t": observe(runs[0], structure, silent, 0)}, structure, Sensors())
    np.testing.assert_allclose(found.noise_by_axis, 0.5e-4)
    assert found.accelerometer_noise == pytest.approx(0.01)
