"""The slab's motion as an input: found within its error, drawn with its covariance, whatever clock and rate read it."""

import numpy as np
import pytest
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.campaigns.clocks import from_command, from_first_reading, since
from blockshake.measurement.motion.measured_base import (
    base_as_motion,
    draw_base,
    measure_base,
)
from blockshake.measurement.sensors.instruments import Instruments

NOISE = Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
COMMAND = load_motion("basso-tirreno", 2.0)
TRUE = with_effect(
    Experiment(None, COMMAND.scaled(1.05), Instruments()), "table-pitch", {"coefficient": 5e-5}, {}
).motion
STRUCTURE = load_structure("configuration-1")
QUIET = 1.5  # s, before the table starts
LAG = 0.012  # s, of the markers' clock behind the accelerometer's


def readings(
    rate, zero=0.0, lag=0.0, markers=("slab-face", "slab-left", "slab-right", "slab-end"), duration=8.0
):
    """A test of the slab alone, loaded: readings from ``zero`` on of a table that starts `QUIET` later."""
    generator = np.random.default_rng(11)
    time = np.arange(round((duration + QUIET) * rate) + 1) / rate
    pose = TRUE.evaluate(time - QUIET) - TRUE.evaluate(np.zeros(1))
    pose[time < QUIET] = 0.0
    chosen = [marker for marker in STRUCTURE.file.markers if marker.name in markers]
    arms = STRUCTURE.arms(chosen)
    cosine, sine = np.cos(pose[:, 3, None]), np.sin(pose[:, 3, None])
    moved = pose[:, None, :3] + np.stack(
        [
            (cosine - 1.0) * arms[:, 0] + sine * arms[:, 2],
            np.zeros((len(time), len(arms))),
            (cosine - 1.0) * arms[:, 2] - sine * arms[:, 0],
        ],
        axis=-1,
    )
    read = moved + generator.normal(0.0, NOISE.marker_noise, moved.shape)
    time_acc = np.arange(round((duration + QUIET) * 512.0) + 1) / 512.0
    since = time_acc - QUIET
    level = np.where(since >= 0.0, TRUE.evaluate(since, 2)[:, 0] - 9.81 * TRUE.evaluate(since)[:, 3], 0.0)
    level = level + 0.05 + generator.normal(0.0, NOISE.accelerometer_noise, len(level))
    test = xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), read - read[:1]),
            "accelerometer": (("time_acc", "channel"), level[:, None]),
        },
        {
            "time": zero + time + lag, "marker": [marker.name for marker in chosen], "axis": ["x", "y", "z"],
            "time_acc": zero + time_acc, "channel": ["slab-acc-x"],
        },
    )  # fmt: skip
    return from_command(from_first_reading(test), STRUCTURE, COMMAND)


@pytest.mark.parametrize(
    ("rate", "zero", "lag", "pitch_error"), [(200.0, 0.0, 0.0, 4e-5), (120.0, 1000.0, LAG, 8e-5)]
)
def test_the_input_is_the_table_s_motion_whatever_the_clock_and_the_rate(rate, zero, lag, pitch_error):
    test = readings(rate, zero, lag)
    base = measure_base(test, STRUCTURE, NOISE, COMMAND)
    assert base.attrs["start"] == 0.0
    assert test["time"][0] == pytest.approx(-QUIET, abs=0.002)
    assert base.attrs["accelerometer_lag"] == pytest.approx(lag, abs=3e-4)
    drawn = base_as_motion(base, draw_base(base, np.random.default_rng(1)), "drawn", {})
    time = np.arange(0.0, 7.9, 0.01)
    late = -float(test["time"][0]) - QUIET
    error = drawn.evaluate(time) - (TRUE.evaluate(time + late) - TRUE.evaluate(np.full(1, late)))
    assert np.sqrt(np.mean(error[:, 0] ** 2)) < 5e-5
    assert np.sqrt(np.mean(error[:, 3] ** 2)) < pitch_error
    rate_error = drawn.evaluate(time, 1)[:, 0] - TRUE.evaluate(time + late, 1)[:, 0]
    assert np.sqrt(np.mean(rate_error**2)) < 1e-3
    clock = since(test, base.attrs["start"])["time"].to_numpy()
    assert 0.0 <= clock[0] < 1.0 / rate


def test_draws_scatter_as_the_readings_leave_the_base_uncertain():
    base = measure_base(readings(200.0, duration=4.0), STRUCTURE, NOISE, COMMAND)
    drawn = np.array([draw_base(base, np.random.default_rng(seed)) for seed in range(60)])
    at = base["of_markers"].to_numpy() == 1
    error = base["displacement_error"].to_numpy()[at]
    shift = (drawn - base["displacement"].to_numpy()[at]) / error
    inner = slice(50, -50)
    assert np.sqrt(np.mean(shift[:, inner] ** 2, axis=(0, 1))) == pytest.approx(1.0, abs=0.2)
    # neighbours in time err together: a draw is a motion, not noise
    steps = np.diff(drawn[:, inner, 0] - drawn[:, inner, 0].mean(axis=0), axis=1)
    assert steps.std() < 0.2 * np.median(error[inner, 0])


def test_one_marker_tells_no_pitch():
    test = readings(200.0, markers=("slab-face",), duration=3.0)
    base = measure_base(test, STRUCTURE, NOISE, COMMAND)
    assert not draw_base(base, np.random.default_rng(1))[:, 3].any()


def test_a_table_that_does_not_follow_starts_with_its_record():
    test = readings(200.0, zero=3.0, duration=3.0)
    test["marker_displacement"][:] = 0.0
    base = measure_base(from_command(test, STRUCTURE, COMMAND), STRUCTURE, NOISE, COMMAND)
    assert base.attrs["follows"] == 0
    assert base.attrs["start"] == 0.0
