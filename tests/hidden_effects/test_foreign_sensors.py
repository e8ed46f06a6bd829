"""Sensors of other laboratories: noise of the stated size and memory, uneven, growing, quantised; gains that vary."""

import foreign_sensors
import numpy as np
import pytest
import xarray as xr
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE

N_TIMES, STEP = 200_000, 1.0 / 200.0
PLAIN = {"size": [1.0, 1.5, 1.0], "slow": 0.0, "memory": 0.1, "growth": 0.0, "quantum": 0.0}
NO_GAIN = {"system": 0.0, "marker": 0.0, "channel": 0.0}


def _read(exact=0.0, gaps=0.0, gain=NO_GAIN, **marker):
    """Readings of two markers that stay ``exact`` off their first place."""
    displacement = np.full((N_TIMES, 2, 3), exact)
    displacement[0] = 0.0
    test = xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), displacement),
            "marker_initial_position": (("marker", "axis"), np.zeros((2, 3))),
            "accelerometer": (("time_acc", "channel"), np.zeros((N_TIMES, 2))),
        },
        {"time": STEP * np.arange(N_TIMES), "time_acc": STEP * np.arange(N_TIMES)},
    )
    sensors = {"marker": PLAIN | marker, "channel": PLAIN, "gaps": gaps, "gain": gain}
    read = foreign_sensors.read(test, sensors, 3, 0)
    return read["marker_displacement"].to_numpy() + read["marker_initial_position"].to_numpy(), read


def test_noise_has_the_stated_size_by_axis():
    marker, read = _read()
    assert marker[1:].std(axis=(0, 1)) == pytest.approx(MARKER_NOISE * np.array([1.0, 1.5, 1.0]), rel=0.02)
    assert read["accelerometer"].std(dim="time_acc").to_numpy() == pytest.approx(
        ACCELEROMETER_NOISE, rel=0.02
    )


def test_the_slow_share_has_its_memory():
    marker, _ = _read(slow=0.3)
    noise = marker[1:, :, 0] / MARKER_NOISE
    assert noise.var() == pytest.approx(1.0, rel=0.05)
    for lag in (2, 20):
        product = (noise[lag:] * noise[:-lag]).mean()
        # 1/sqrt of the number of memories in the record, times the share
        assert product == pytest.approx(0.3 * np.exp(-lag * STEP / 0.1), abs=0.015)


def test_noise_grows_with_the_reading():
    near, far = (_read(exact, growth=5e-4)[0][1:, :, 0].std() for exact in (0.0, 0.4))
    assert near == pytest.approx(MARKER_NOISE, rel=0.02)
    assert far == pytest.approx(np.hypot(MARKER_NOISE, 2e-4), rel=0.02)


def test_readings_are_quantised():
    marker, _ = _read(quantum=5e-5)
    assert np.abs(marker / 5e-5 - np.round(marker / 5e-5)).max() < 1e-6


def test_gaps_are_runs_and_never_first():
    marker, _ = _read(gaps=0.02)
    lost = np.isnan(marker[..., 0])
    assert not lost[0].any()
    assert lost.mean() == pytest.approx(0.02, rel=0.2)
    starts = (np.diff(lost.astype(int), axis=0) == 1).sum()
    assert lost.sum() / starts == pytest.approx(15.0, rel=0.2)


def test_gains_are_those_of_the_case():
    exact, gain = 0.4, {"system": 0.0, "marker": 0.1, "channel": 0.0}
    marker, _ = _read(exact, gain=gain)
    error = marker[1:, :, 0].mean(axis=0) / exact - 1.0
    assert error[0] != pytest.approx(error[1], abs=1e-3)
    assert np.abs(error).max() < 0.5


def test_sensors_are_drawn_by_the_seed_and_some_are_white():
    drawn = [foreign_sensors.true_sensors(seed) for seed in range(400)]
    assert drawn[:20] == [foreign_sensors.true_sensors(seed) for seed in range(20)]
    white = np.mean([one["marker"]["slow"] == 0.0 for one in drawn])
    # four standard deviations of a share of 0.3
    assert abs(white - 0.3) < 4.0 * np.sqrt(0.21 / 400)
    assert all(one["gain"]["system"] == 0.0 for one in drawn)
    assert foreign_sensors.true_sensors(1, gains=True)["gain"]["system"] > 0.0
