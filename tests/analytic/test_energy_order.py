"""Velocity Verlet on undamped, frictionless contact: the energy error falls with the square of the step."""

import numpy as np
import pytest

G = 9.81
STEPS = np.array([8e-5, 4e-5, 2e-5, 1e-5])
MASS = 0.5 * 2400.0
SQUAT = {"squat": {"box": [1.0, 1.0, 0.5]}}


def _worst(make_structure, run_ls_dem, body, duration):
    structure = make_structure([body], friction=0.0, restitution=1.0, shapes=SQUAT)
    worst = []
    for dt in STEPS:
        run = run_ls_dem(structure, duration, time_step=dt, rate=1000)
        total = run.energy[:, :3].sum(axis=1)
        # nothing but kinetic, potential and elastic energy, and no driven work
        assert np.abs(run.energy[:, 3:]).max() == 0.0
        worst.append(np.abs(total - total[0]).max())
    return np.array(worst)


def test_a_face_that_stays_closed(make_structure, run_ls_dem):
    """Bounce and nod within the static depth: the weight's 5e-7 m against 2e-7 m of motion."""
    omega = np.sqrt(2.16e10 / MASS)
    speed = 2e-7 * omega
    body = {
        "name": "b", "shape": "squat", "position": [0.3, 0.1, 0.25],
        "velocity": [0.05, -0.02, -speed], "angular_velocity": [0.3 * speed, 0.5 * speed, 0.0],
    }  # fmt: skip
    worst = _worst(make_structure, run_ls_dem, body, 0.03)
    in_play = 0.5 * MASS * speed**2
    # the scheme keeps a shadow energy; the true one swings about it by (omega dt)^2 / 8 of what is in play,
    # and the weight's spring energy at most doubles it
    assert worst[-1] < (omega * STEPS[-1]) ** 2 * in_play
    np.testing.assert_allclose(np.log2(worst[:-1] / worst[1:]), 2.0, atol=0.15)


def test_a_face_that_opens_and_closes(make_structure, run_ls_dem):
    """A block let fall flat by 1 mm bounces at full height: each kink costs of second order at the most.

    The error of a kink depends on where in a step it falls; so each step's worst is bounded, and the
    trend over a factor of eight and three heights is read, not each pair of steps.
    """
    omega = np.sqrt(2.16e10 / MASS)
    logarithms = []
    for height in (0.9e-3, 1.0e-3, 1.1e-3):
        body = {"name": "b", "shape": "squat", "position": [0.3, 0.1, 0.25 + height]}
        worst = _worst(make_structure, run_ls_dem, body, 0.2)
        # each kink may shift the shadow energy by (omega dt)^2 / 8 of what is in play: two a bounce, seven bounces
        assert (worst < 14.0 * (omega * STEPS) ** 2 / 8.0 * MASS * G * height).all()
        logarithms.append(np.log(worst))
    slope = np.polyfit(np.log(STEPS), np.mean(logarithms, axis=0), 1)[0]
    assert slope == pytest.approx(2.0, abs=0.35)
