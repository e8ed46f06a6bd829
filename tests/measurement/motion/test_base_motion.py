import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.measurement.motion.base_motion import smoothed_base
from blockshake.measurement.sensors.accelerometers import FINE_RATE, RATE, low_pass

MARKER_NOISE, ACCELEROMETER_NOISE, OFFSET = 1e-4, 0.02, 0.15
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
    reading = acceleration + OFFSET + rng.normal(0.0, ACCELEROMETER_NOISE, len(time_acc))
    return {
        "time": time, "marker": position - position[0], "time_acc": time_acc, "reading": reading,
        "displacement": displacement, "velocity": motion.evaluate(time, derivative=1)[:, 0],
    }  # fmt: skip


def _rms(values):
    return float(np.sqrt(np.mean(values**2)))


@pytest.fixture(scope="module")
def fused(measured):
    return smoothed_base(
        measured["time"], measured["marker"], MARKER_NOISE, measured["time_acc"], measured["reading"],
        ACCELEROMETER_NOISE,
    )  # fmt: skip


def test_marker_and_accelerometer_together_give_the_velocity_within_2_mm_per_s(measured, fused):
    assert _rms(fused.velocity - measured["velocity"]) < 2e-3
    assert fused.accelerometer_offset == pytest.approx(OFFSET, abs=0.01)


def test_the_stated_uncertainty_is_that_of_the_errors(measured, fused):
    """Standardised errors have a mean square of one, within what correlated errors leave."""
    inner = slice(100, -100)
    score = ((fused.velocity - measured["velocity"]) / fused.velocity_error)[inner]
    assert 0.5 < _rms(score) < 1.5
    assert np.mean(np.abs(score) < 1.96) > 0.85


def test_a_marker_alone_is_better_than_its_differences(measured):
    alone = smoothed_base(measured["time"], measured["marker"], MARKER_NOISE)
    differences = np.gradient(measured["marker"], measured["time"])
    assert _rms(alone.velocity - measured["velocity"]) < 0.6 * _rms(differences - measured["velocity"])
    assert np.isnan(alone.accelerometer_offset)
    assert np.median(alone.velocity_error) > 0.0


def test_a_gap_is_filled_and_its_uncertainty_grows(measured, fused):
    marker = measured["marker"].copy()
    marker[2000:2040] = np.nan  # 0.2 s in the strong part
    gap = smoothed_base(
        measured["time"], marker, MARKER_NOISE, measured["time_acc"], measured["reading"], ACCELEROMETER_NOISE
    )
    assert np.isfinite(gap.displacement).all()
    assert gap.displacement_error[2020] > 1.5 * fused.displacement_error[2020]
    error = np.abs(gap.displacement - measured["displacement"])[2000:2040]
    # the first reading's error is in all of them
    assert error.max() < 5.0 * gap.displacement_error[2000:2040].max() + 3.0 * MARKER_NOISE


def test_a_uniform_acceleration_is_followed_exactly():
    """Theory: a parabola is in the model's reach; what is left is the noise through the filter."""
    time = np.arange(0.0, 2.0, 0.005)
    true = np.where(time > 0.5, 0.5 * 2.0 * (time - 0.5) ** 2, 0.0)
    rng = np.random.default_rng(1)
    found = smoothed_base(time, true + rng.normal(0.0, 1e-6, len(time)), 1e-6)
    late = time > 0.8
    assert np.abs(found.velocity - 2.0 * (time - 0.5))[late].max() < 1e-3


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"time": [0.0, 0.1, 0.1, 0.2]}, "time: expected times that increase"),
        ({"marker": [0.0, np.nan, 0.0, 0.0]}, "marker: expected at least four readings"),
        ({"marker_noise": 0.0}, "marker_noise: expected a positive number"),
    ],
)
def test_bad_input_is_one_line(keys, message):
    given = {"time": [0.0, 0.1, 0.2, 0.3], "marker": [0.0, 0.0, 0.0, 0.0], "marker_noise": 1e-4} | keys
    with pytest.raises(InputError, match=message):
        smoothed_base(**given)
