"""Coulomb's limit on an incline, half a percent either side of it, for minutes of simulated time."""

import numpy as np
import pytest

G = 9.81
MU = 0.5
STEP = 5e-5
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}}
# stretch of the shear springs at the limit, mu m g / (k_s A), metres
STRETCH = MU * 0.5 * 2400.0 * G / 9.0e9


def _tilted(slope):
    angle = np.arctan(slope)
    return [G * np.sin(angle), 0.0, -G * np.cos(angle)], G * (np.sin(angle) - MU * np.cos(angle))


@pytest.mark.slow
def test_half_a_percent_below_the_limit_it_stays_for_two_minutes(make_structure, run_ls_dem):
    """tan(angle) < mu holds for ever: 120 s are 2.4 million steps, and a femtometre a step would show."""
    gravity, _ = _tilted(0.995 * MU)
    body = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
    run = run_ls_dem(
        make_structure([body], friction=MU, gravity=gravity, shapes=SHAPES), 120.0, rate=1, time_step=STEP
    )
    assert run.status == "completed"
    # nodes still give way to one another while the last 1e-9 of imbalance dies out, in the first second
    assert np.abs(run.position - run.position[0]).max() < 1e-7 * STRETCH
    assert np.abs(run.position[10:] - run.position[10]).max() < 1e-9 * STRETCH
    assert run.energy[-1, 3] < 1e-12


@pytest.mark.slow
def test_a_stack_at_rest_half_a_percent_below_stays_a_minute(make_structure, run_ls_dem):
    """Two flat blocks: each joint is as near to its limit as the other."""
    gravity, _ = _tilted(0.995 * MU)
    bodies = [
        {"name": name, "shape": "squat", "position": [0.0, 0.0, z]}
        for name, z in (("low", 0.25), ("high", 0.75))
    ]
    run = run_ls_dem(
        make_structure(bodies, friction=MU, gravity=gravity, shapes=SHAPES), 60.0, rate=1, time_step=STEP
    )
    assert np.abs(run.position - run.position[0]).max() < 1e-6 * STRETCH
    assert np.abs(run.position[10:] - run.position[10]).max() < 1e-9 * STRETCH


@pytest.mark.slow
def test_half_a_percent_above_it_slides_a_hundred_metres(make_structure, run_ls_dem):
    """Acceleration g (sin - mu cos), 0.022 m/s2, for 100 s: as exactly at the end as at the start.

    The slab has nodes at its ends and its middle alone, so that none comes under the sliding block: one that
    enters through the leading edge is pushed against the sliding for an instant, and what is tested here is
    Coulomb's law.
    """
    gravity, acceleration = _tilted(1.005 * MU)
    duration = 100.0
    reach = 0.5 * acceleration * duration**2
    shapes = {**SHAPES, "slab": {"box": [2.4 * reach, 1.4, 0.2]}}
    body = {"name": "b", "shape": "squat", "position": [4.0, 0.0, 0.25]}
    structure = make_structure([body], friction=MU, gravity=gravity, shapes=shapes)
    run = run_ls_dem(structure, duration, rate=1, time_step=STEP, node_spacing=reach)
    assert run.status == "completed"
    # before its springs hold back the block gains at most the speed of a mass let go on them; the block's
    # nodes carry alone, which is half of the joint's stiffness
    slack = np.sqrt(MU * G * 2.0 * STRETCH)
    np.testing.assert_allclose(run.velocity[:, 1, 0], acceleration * run.time, atol=slack, rtol=1e-3)
    gone = run.position[-1, 1, 0] - run.position[0, 1, 0]
    assert gone == pytest.approx(reach, abs=slack * duration)
    # Coulomb's heat; the dashpots have some of the first thump, less than m slack^2 / 2 of 600 kJ
    weight = structure.mass[1] * G * np.cos(np.arctan(1.005 * MU))
    assert run.energy[-1, 3] == pytest.approx(MU * weight * gone, rel=1e-5)
