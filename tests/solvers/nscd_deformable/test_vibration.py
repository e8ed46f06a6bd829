"""Waves and vibrations of towers that stick together: transit time, frequencies, damping."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import find_peaks

from blockshake.dynamics.motion import ground_motion

sys.path.insert(0, str(Path(__file__).parent / "block"))
from ritz import ritz_frequencies

E, RHO, LENGTH = 3.45e10, 2400.0, 1.6
SPEED = np.sqrt(E / RHO)


def _step(channel, size, rise, until):
    """Base that moves by ``size`` within ``rise`` and stays."""
    time = np.arange(0.0, until, rise / 20.0)
    shape = np.where(time < rise, 0.5 * (1.0 - np.cos(np.pi * time / rise)), 1.0)
    return ground_motion("step", time, {channel: size * shape}, "displacement")


def _frequency(signal, times):
    """Largest peak of the spectrum of a signal, refined by a parabola [Hz]."""
    x = (signal - signal.mean()) * np.hanning(len(signal))
    spectrum = np.abs(np.fft.rfft(x, 8 * len(x)))
    k = int(spectrum.argmax())
    a, b, c = np.log(spectrum[k - 1 : k + 2])
    return (k + 0.5 * (a - c) / (a - 2.0 * b + c)) / (8 * len(x) * (times[1] - times[0]))


def test_an_axial_wave_arrives_when_it_should(stone, tower, deform):
    """Base at a constant velocity from t = 0: the top block's mean has half of it after (H - L / 2) / c, within 5 %."""
    velocity, until = 1e-4, 0.004
    structure = stone(tower(4), poisson_ratio=0.0)
    time = np.array([0.0, until])
    motion = ground_motion("pull", time, {"z": np.array([velocity, velocity])}, "velocity")
    run = deform(
        structure, until, motion=motion, time_step=1e-5, rate=50000, mesh_size=0.2, contact_spacing=0.4
    )
    top = run.velocity[:, 4, 2]
    arrival = np.interp(0.5 * velocity, np.maximum.accumulate(top), run.time)
    assert arrival == pytest.approx((4 * LENGTH - LENGTH / 2.0) / SPEED, rel=0.05)


def test_a_stuck_tower_has_the_axial_frequency_of_a_rod(stone, tower, deform):
    """Fixed and free, nu 0: c / 4 H, within 1 % at theta 0.5 and a step of 1e-4 s."""
    structure = stone(tower(4), poisson_ratio=0.0)
    motion = _step("z", 2e-7, 2e-3, 0.1)
    run = deform(
        structure, 0.08, motion=motion, time_step=1e-4, rate=10000, mesh_size=0.4, contact_spacing=0.4,
        elastic_theta=0.5,
    )  # fmt: skip
    later = run.time > 0.004
    found = _frequency(run.position[later, 4, 2], run.time[later])
    assert found == pytest.approx(SPEED / (4.0 * 4.0 * LENGTH), rel=0.01)


def test_a_stuck_tower_bends_like_a_clamped_box(stone, tower, deform):
    """First frequency of two blocks in one piece on a clamped foot by Rayleigh and Ritz, within 3 %."""
    structure = stone(tower(2), friction=2.0)
    motion = _step("x", 2e-7, 4e-3, 0.3)
    run = deform(
        structure, 0.25, motion=motion, time_step=5e-4, rate=2000, mesh_size=0.2,
        elastic_theta=0.5,
    )  # fmt: skip
    later = run.time > 0.006
    found = _frequency(run.position[later, 2, 0], run.time[later])
    theory = ritz_frequencies((0.8, 2.4, 3.2), 0.2, 10, 1, clamped=True)[0] * SPEED / (2.0 * np.pi)
    assert found == pytest.approx(theory, rel=0.03)


def test_a_mode_is_damped_as_kelvin_and_voigt_say(stone, tower, deform):
    """All of one material, stuck: the axial mode decays at the ratio eta omega / 2 E, within 5 %."""
    omega = 2.0 * np.pi * SPEED / (16.0 * LENGTH)
    ratio = 0.03
    structure = stone(tower(4), poisson_ratio=0.0, viscous_modulus=2.0 * ratio * E / omega)
    motion = _step("z", 2e-7, 2e-3, 0.1)
    run = deform(
        structure, 0.06, motion=motion, time_step=5e-5, rate=20000, viscous=True, mesh_size=0.4, contact_spacing=0.4,
        elastic_theta=0.5,
    )  # fmt: skip
    later = run.time > 0.006
    x = run.position[later, 4, 2] - run.position[-1, 4, 2]
    peaks = find_peaks(x)[0][:6]
    decrement = np.log(x[peaks[0]] / x[peaks[4]]) / 4.0
    assert decrement / np.sqrt(4.0 * np.pi**2 + decrement**2) == pytest.approx(ratio, rel=0.05)
    assert np.diff(run.energy[:, 5]).min() >= 0.0
