import numpy as np
import pytest

from blockshake.diagnosis.features.excursions import (
    decay,
    growth,
    largest_swing,
    steps,
    turning_acceleration,
    turning_points,
)

TIME = np.arange(1201) / 200.0


def test_turning_points_of_a_sine_under_noise():
    values = np.sin(2.0 * np.pi * TIME) + np.random.default_rng(0).normal(0.0, 0.02, len(TIME))
    places = turning_points(values, 0.2)
    # maxima and minima at every quarter past, within what 0.02 of noise shifts a flat top: sqrt(2 * 0.08) / 2 pi
    np.testing.assert_allclose(TIME[places], 0.25 + 0.5 * np.arange(12), atol=0.07)


def test_small_reversals_are_none():
    assert len(turning_points(0.01 * np.sin(TIME * 9.0), 0.05)) == 0
    assert len(turning_points(np.zeros(100), 0.1)) == 0


def test_steps_of_a_staircase():
    values = np.interp(TIME, [0, 1, 1.1, 2, 2.1, 3, 3.1, 6], [0, 0, 3.0, 3.0, 1.0, 1.0, 5.0, 5.0])
    _, sizes = steps(values, 0.5)
    np.testing.assert_allclose(sizes, [3.0, -2.0, 4.0])


@pytest.mark.parametrize("exponent", [1.0, 2.5])
def test_growth_is_the_exponent(exponent):
    drives = np.array([1.0, 1.3, 1.7, 2.2, 2.8])
    values, drive = np.zeros(len(TIME)), np.zeros(len(TIME))
    for number, size in enumerate(drives):
        begin, sign = 1.0 * number + 0.5, (-1.0) ** number
        values += sign * size**exponent * np.clip((TIME - begin) / 0.2, 0.0, 1.0)
        drive += size * ((begin <= TIME) & (begin + 0.2 >= TIME))
    assert growth(values, drive, 0.2) == pytest.approx(exponent, rel=1e-9)
    assert growth(values[:400], drive[:400], 0.2) is None


def test_a_damped_swing_has_its_period_and_decrement():
    """theta = A exp(-d t) sin(2 pi t / T): turns T / 2 apart, ratio exp(d T / 2)."""
    period, damping = 0.8, 0.5
    values = 3.0 + 0.02 * np.exp(-damping * TIME) * np.sin(2.0 * np.pi * TIME / period)
    found = decay(TIME, values, 1e-3)
    # turning points fall on readings: 5 ms in 0.4 s
    assert found.period == pytest.approx(period, abs=0.01)
    # a flat top costs (2 pi 0.0025 / 0.8)^2 / 2 of a swing
    assert found.decrement == pytest.approx(damping * period / 2.0, abs=5e-4)
    # turns at 0.19 + 0.4 n s: 15 until 6 s, all of more than 1 mrad
    assert found.half_cycles == 14
    assert decay(TIME[:100], values[:100], 1e-3) is None


def test_the_largest_swing_is_half_a_period():
    """Of half a sine of length T, T (1 - 2 asin(1/4) / pi) are beyond a quarter."""
    values = np.where(TIME < 2.0, 0.1 * np.sin(8.0 * TIME), -np.sin(np.pi * (TIME - 2.0) / 0.9))
    values[TIME > 2.9] = 0.0
    assert largest_swing(TIME, values) == pytest.approx(
        0.9 * (1.0 - 2.0 * np.arcsin(0.25) / np.pi), abs=0.002
    )


def test_a_stopper_turns_faster_than_gravity():
    gravity = 0.02 * np.sin(2.0 * np.pi * TIME)
    assert turning_acceleration(TIME, gravity, 0.001) == pytest.approx(0.02 * (2.0 * np.pi) ** 2, rel=0.01)
    # thrown back at 15 mm with the speed it came with, 0.1 m/s, within 25 ms: 2 v / t on average
    stopped = 0.015 - 0.1 * np.abs(np.mod(TIME, 0.6) - 0.3)
    assert turning_acceleration(TIME, stopped, 0.001) > 4.0
    assert turning_acceleration(TIME, np.zeros(len(TIME)), 0.001) is None


def test_a_history_without_a_value_has_no_turn():
    assert len(turning_points(np.empty(0), 1.0)) == 0
