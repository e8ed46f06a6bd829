import numpy as np
import pytest

from blockshake.dynamics.baseline import (
    close_integrals,
    correct_baseline,
    end_of_motion,
    high_pass,
    taper_ends,
)

STEP = 0.01


def wavelet(time):
    """Displacement and acceleration of a 1 Hz wavelet of 0.05 m about t = 10 s, by calculus."""
    s, w = time - 10.0, 2.0 * np.pi
    bell = 0.05 * np.exp(-(s**2) / 8.0)
    first, second = -s / 4.0, s**2 / 16.0 - 0.25
    return bell * np.sin(w * s), bell * ((second - w**2) * np.sin(w * s) + 2.0 * first * w * np.cos(w * s))


def displacement_of(acceleration):
    velocity = np.concatenate([[0.0], np.cumsum(STEP * (acceleration[:-1] + acceleration[1:]) / 2.0)])
    moved = STEP * velocity[:-1] + STEP**2 * (2.0 * acceleration[:-1] + acceleration[1:]) / 6.0
    return np.concatenate([[0.0], np.cumsum(moved)])


def test_end_of_motion_is_exact_for_a_ramp():
    # a = 3 t: v = 1.5 t^2, d = 0.5 t^3
    time = STEP * np.arange(401)
    velocity, displacement = end_of_motion(3.0 * time, STEP)
    assert velocity == pytest.approx(24.0, rel=1e-12)
    assert displacement == pytest.approx(32.0, rel=1e-12)


def test_closing_removes_a_linear_acceleration_and_nothing_else():
    time = STEP * np.arange(2001)
    drift = 0.02 - 0.003 * time
    np.testing.assert_allclose(close_integrals(drift, STEP), 0.0, atol=1e-13)


def test_corrected_record_ends_at_rest_where_it_began():
    rng = np.random.default_rng(5)
    velocity, displacement = end_of_motion(correct_baseline(rng.normal(size=4000), STEP), STEP)
    # rounding of 4000 terms of order one, doubly summed over 40 s
    assert abs(velocity) < 1e-11
    assert abs(displacement) < 1e-10


def test_true_displacement_comes_back_from_a_drifting_record():
    time = STEP * np.arange(2001)
    true, acceleration = wavelet(time)
    recorded = acceleration + 0.02 + 0.01 * (time > 9.0)  # an offset, and a tilt in the strong part
    # the offsets alone carry the raw record metres away
    assert np.abs(displacement_of(recorded)).max() > 1.0
    # what the filter leaves of a step of 0.01 m/s2 is of the order of step / (2 pi f_c)^2 = 25 mm
    assert np.abs(displacement_of(correct_baseline(recorded, STEP)) - true).max() < 0.025
    # without drift nothing but the filter's own ripple is changed
    assert np.abs(displacement_of(correct_baseline(acceleration, STEP)) - true).max() < 5e-4


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_filter_has_the_amplitude_of_butterworth_twice(ratio):
    # a long sine seen in its middle, away from the ends: |H|^2 = r^8 / (1 + r^8), no phase shift
    time = STEP * np.arange(40000)
    sine = np.sin(2.0 * np.pi * 0.1 * ratio * time)
    middle = slice(18000, 22000)
    expected = ratio**8 / (1.0 + ratio**8)
    np.testing.assert_allclose(high_pass(sine, STEP, 0.1)[middle], expected * sine[middle], atol=2e-3)


def test_taper_touches_two_percent_at_each_end():
    tapered = taper_ends(np.ones(1000))
    assert tapered[0] == 0.0
    assert tapered[-1] == 0.0
    np.testing.assert_array_equal(tapered[20:-20], 1.0)
    assert tapered[10] == pytest.approx(0.5)
