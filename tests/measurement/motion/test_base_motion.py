import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.measurement.motion.base_motion import most_probable_density, smooth_readings, together
from blockshake.measurement.motion.kalman import DISPLACEMENT, OFFSET, VELOCITY
from blockshake.measurement.sensors.accelerometers import FINE_RATE, RATE, low_pass

MARKER_NOISE, ACCELEROMETER_NOISE, OFFSET_READ = 1e-4, 0.02, 0.15
DURATION = 20.0


@pytest.fixture(scope="module")
def measured():
    """Basso Tirreno (synthetic) at 100 %, as a marker of 200 Hz and an accelerometer of 512 Hz would read it."""
    motion = load_motion("basso-tirreno")
    time = np.arange(round(DURATION * 200.0) + 1) / 200.0
    time_acc = np.arange(round(DURATION * RATE) + 1) / RATE
    rng = np.random.default_rng(7)
    displacement = motion.evaluate(time)[:, 0] - motion.evaluate(np.zeros(1))[0, 0]
    position = displacement + rng.normal(0.0, MARKER_NOISE, len(time))
    fine = np.arange(round(DURATION * FINE_RATE) + 1) / FINE_RATE
    velocity = motion.evaluate(fine, derivative=1)[:, 0]
    acceleration = low_pass(np.gradient(velocity, fine)[:, None])[:: round(FINE_RATE / RATE), 0]
    reading = acceleration + OFFSET_READ + rng.normal(0.0, ACCELEROMETER_NOISE, len(time_acc))
    return {
        "time": time, "marker": position - position[0], "time_acc": time_acc, "reading": reading,
        "displacement": displacement, "velocity": motion.evaluate(time, derivative=1)[:, 0],
    }  # fmt: skip


def _rms(values):
    return float(np.sqrt(np.mean(values**2)))


def _smoothed(time, marker, time_acc=(), reading=(), noise=MARKER_NOISE):
    """Smoothed states at the marker's times, (n_times, 4), and their standard deviations."""
    readings = together(time, marker, noise, np.array(time_acc), np.array(reading), ACCELEROMETER_NOISE)
    smoothed = smooth_readings(readings, most_probable_density(readings))
    there = np.searchsorted(readings.time, time - 1e-7)
    return smoothed.mean[there], np.sqrt(np.diagonal(smoothed.covariance[there], axis1=1, axis2=2))


@pytest.fixture(scope="module")
def fused(measured):
    return _smoothed(measured["time"], measured["marker"], measured["time_acc"], measured["reading"])


def test_marker_and_accelerometer_together_give_the_velocity_within_2_mm_per_s(measured, fused):
    states, _ = fused
    assert _rms(states[:, VELOCITY] - measured["velocity"]) < 2e-3
    assert states[-1, OFFSET] == pytest.approx(OFFSET_READ, abs=0.01)


def test_the_stated_uncertainty_is_that_of_the_errors(measured, fused):
    """Standardised errors have a mean square of one, within what correlated errors leave."""
    inner = slice(100, -100)
    states, errors = fused
    score = ((states[:, VELOCITY] - measured["velocity"]) / errors[:, VELOCITY])[inner]
    assert 0.5 < _rms(score) < 1.5
    assert np.mean(np.abs(score) < 1.96) > 0.85


def test_a_marker_alone_is_better_than_its_differences(measured):
    alone, errors = _smoothed(measured["time"], measured["marker"])
    differences = np.gradient(measured["marker"], measured["time"])
    assert _rms(alone[:, VELOCITY] - measured["velocity"]) < 0.6 * _rms(differences - measured["velocity"])
    assert np.median(errors[:, VELOCITY]) > 0.0


def test_a_gap_is_filled_and_its_uncertainty_grows(measured, fused):
    marker = measured["marker"].copy()
    marker[2000:2040] = np.nan  # 0.2 s in the strong part
    states, errors = _smoothed(measured["time"], marker, measured["time_acc"], measured["reading"])
    assert np.isfinite(states).all()
    assert errors[2020, DISPLACEMENT] > 1.5 * fused[1][2020, DISPLACEMENT]
    error = np.abs(states[:, DISPLACEMENT] - measured["displacement"])[2000:2040]
    # the first reading's error is in all of them
    assert error.max() < 5.0 * errors[2000:2040, DISPLACEMENT].max() + 3.0 * MARKER_NOISE


def test_a_uniform_acceleration_is_followed_exactly():
    """Theory: a parabola is in the model's reach; what is left is the noise through the filter."""
    time = np.arange(0.0, 2.0, 0.005)
    true = np.where(time > 0.5, 0.5 * 2.0 * (time - 0.5) ** 2, 0.0)
    rng = np.random.default_rng(1)
    states, _ = _smoothed(time, true + rng.normal(0.0, 1e-6, len(time)), noise=1e-6)
    late = time > 0.8
    assert np.abs(states[:, VELOCITY] - 2.0 * (time - 0.5))[late].max() < 1e-3
