import numpy as np
import pytest
from scipy.signal import lsim

from blockshake.dynamics.intensity import response_spectrum
from blockshake.dynamics.motion import ground_motion

# 32 points a cycle: the peak between two of them is missed by 1 - cos(pi / 32) at most
MISSED = 1.0 - np.cos(np.pi / 32.0)


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_step_overshoots_as_in_theory(damping):
    # Chopra, Dynamics of Structures, 4.3: constant force from rest, first peak
    motion = ground_motion("step", [0.0, 50.0], {"x": [1.5, 1.5]}, "acceleration")
    overshoot = 1.5 * (1.0 + np.exp(-np.pi * damping / np.sqrt(1.0 - damping**2)))
    spectrum = response_spectrum(motion, [0.3, 1.0, 7.0], damping=damping)
    assert np.all(spectrum <= overshoot * (1.0 + 1e-9))
    np.testing.assert_allclose(spectrum, overshoot, rtol=MISSED)


def test_harmonic_excitation_as_in_theory():
    # u'' + 2 z w u' + w^2 u = -sin(p t) from rest: steady part plus the decaying part that cancels it at 0
    w, p, z = 2.0 * np.pi / 0.8, 2.0 * np.pi, 0.05
    time = np.linspace(0.0, 12.0, 12001)  # 1000 rows a cycle: a chord misses the sine by (p dt)^2 / 8 = 5e-6
    stiff, damp = w**2 - p**2, 2.0 * z * w * p
    sin_part, cos_part = -stiff / (stiff**2 + damp**2), damp / (stiff**2 + damp**2)
    wd = w * np.sqrt(1.0 - z**2)
    free = -(sin_part * p + z * w * cos_part) / wd
    u = np.exp(-z * w * time) * (-cos_part * np.cos(wd * time) + free * np.sin(wd * time))
    u += sin_part * np.sin(p * time) + cos_part * np.cos(p * time)
    motion = ground_motion("sine", time, {"z": np.sin(p * time)}, "acceleration")
    assert response_spectrum(motion, [0.8], axis="z")[0] == pytest.approx(w**2 * np.abs(u).max(), rel=2e-5)


def test_recursion_is_exact_for_random_acceleration():
    # lsim with linear interpolation of the input is an independent exact solution
    acceleration = np.random.default_rng(1).normal(size=800)
    time = 0.01 * np.arange(800)
    motion = ground_motion("noise", time, {"x": acceleration}, "acceleration")
    for period in (0.33, 2.0):  # above 32 rows a cycle no peak is sought between rows
        w = 2.0 * np.pi / period
        system = ([[0.0, 1.0], [-w * w, -0.1 * w]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
        u = lsim(system, acceleration, time)[1]
        assert response_spectrum(motion, [period])[0] == pytest.approx(w * w * np.abs(u).max(), rel=1e-9)


def test_rows_that_add_nothing_change_nothing():
    time = np.linspace(0.0, 4.0, 81)
    values = np.random.default_rng(2).normal(size=81)
    finer = np.sort(np.concatenate([time, time[:-1] + 0.013, [1.777]]))
    coarse = ground_motion("coarse", time, {"x": values}, "acceleration")
    fine = ground_motion("fine", finer, {"x": np.interp(finer, time, values)}, "acceleration")
    periods = [0.1, 0.5, 1.5]
    np.testing.assert_allclose(
        response_spectrum(fine, periods), response_spectrum(coarse, periods), rtol=2 * MISSED
    )


def test_limits_are_peak_acceleration_and_peak_displacement():
    time = np.linspace(0.0, 3.0, 601)
    motion = ground_motion("pulse", time, {"x": np.sin(2.0 * np.pi * time / 3.0) ** 3}, "acceleration")
    assert response_spectrum(motion, [0.01])[0] == pytest.approx(1.0, rel=0.01)  # follows the base
    stays = response_spectrum(motion, [2000.0], damping=0.0)[0] * (2000.0 / (2.0 * np.pi)) ** 2
    assert stays == pytest.approx(np.abs(motion.evaluate(time)[:, 0]).max(), rel=1e-4)  # stays where it was
