"""Housner's (1963) rigid block, which NSCD is: periods, impacts, and where the joules go."""

import numpy as np
import pytest
from both_solvers import leans
from rocking_theory import G, H, Rocker

STEP = 2e-4  # s
ROCKER = Rocker(0.0)
KINETIC, POTENTIAL, ELASTIC, FRICTION, CONTACT, VISCOUS, INPUT = range(7)


def _next_angle(angle):
    """Lean that the block reaches after an impact that keeps Housner's part of the angular velocity; energy."""
    left = ROCKER.housner**2 * (np.cos(ROCKER.alpha - angle) - np.cos(ROCKER.alpha))
    return ROCKER.alpha - np.arccos(np.cos(ROCKER.alpha) + left)


@pytest.fixture(scope="module")
def rocking(make_structure, run_nscd):
    structure = make_structure([ROCKER.body(0.6 * ROCKER.alpha)], friction=2.0)
    return structure, run_nscd(structure, 4.0, time_step=STEP, rate=5000)


def test_periods_and_amplitudes_are_housners(rocking):
    """Four half cycles: each peak and half period that follow from the peak before, within 1 % at dt 2e-4."""
    _, run = rocking
    lean = leans(run)
    impacts = np.flatnonzero(lean[:-1] * lean[1:] < 0.0)
    angle, upright = 0.6 * ROCKER.alpha, ROCKER.quarter(0.6 * ROCKER.alpha)
    assert run.time[impacts[0]] == pytest.approx(upright, rel=0.01)
    for index in range(4):
        peak = np.abs(lean[impacts[index] : impacts[index + 1]]).max()
        assert peak == pytest.approx(_next_angle(angle), rel=0.01)
        angle = peak
        assert np.diff(run.time[impacts[index : index + 2]]) == pytest.approx(
            2.0 * ROCKER.quarter(angle), rel=0.01
        )


def test_angular_velocities_at_impacts_have_housners_ratio(rocking):
    """Four impacts, read three steps before and after: r = 1 - 2 m b^2 / I within 1 %."""
    _, run = rocking
    lean, spin = leans(run), run.angular_velocity[:, 1, 1]
    for impact in np.flatnonzero(lean[:-1] * lean[1:] < 0.0)[:4]:
        # gravity's moment changes the angular velocity by p^2 sin(alpha) dt a step, 0.1 % of it
        assert spin[impact + 4] / spin[impact - 3] == pytest.approx(ROCKER.housner, rel=0.01)


def test_impacts_take_the_energy_that_housner_says_and_nothing_else_does(rocking):
    """Each impact leaves r^2 of the energy; the contact term has it, friction and the audit's residual nothing."""
    structure, run = rocking
    in_play = structure.mass[1] * G * (run.position[0, 1, 2] - H)
    lean = leans(run)
    for order, impact in enumerate(np.flatnonzero(lean[:-1] * lean[1:] < 0.0)[:4], start=1):
        lost = run.energy[impact + 5, CONTACT]
        assert lost == pytest.approx(in_play * (1.0 - ROCKER.housner ** (2 * order)), rel=0.01)
    assert run.energy[-1, FRICTION] < 1e-3 * in_play
    e = run.energy - run.energy[0]
    residual = e[:, :3].sum(axis=1) + e[:, 3:6].sum(axis=1) - e[:, INPUT]
    assert np.abs(residual).max() < 1e-4 * in_play
    assert np.diff(run.energy[:, 3:5], axis=0).min() >= 0.0
