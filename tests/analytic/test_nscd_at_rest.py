"""NSCD in equilibrium: every body is held by its joints, nothing moves, nothing sinks; Coulomb's limit to 0.5 %."""

import numpy as np
import pytest

from blockshake.geometry.structure import load_structure

G = 9.81
MU = 0.5
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}}
TOLERANCE = 1e-8  # default of nscd.tolerance


@pytest.mark.parametrize("configuration", [1, 2, 3, 4])
def test_forces_balance_and_nothing_sinks(configuration, run_nscd):
    """Newton's first law for each body of the shipped structures, redundant supports included."""
    structure = load_structure(f"configuration-{configuration}")
    run = run_nscd(structure, 2.0)
    held = np.zeros((len(run.time), len(structure.mass), 3))
    for joint, (a, b) in enumerate(run.joints):
        held[:, a] -= run.joint_force[:, joint]
        held[:, b] += run.joint_force[:, joint]
    weight = structure.mass[:, None] * np.array([0.0, 0.0, G])
    free = ~structure.driven
    # what the residual leaves of all impulses together; a body's imbalance is its change of velocity, and the
    # stack's weight is carried by a dozen contacts in each of a few joints
    imbalance = 10.0 * TOLERANCE * weight[free].sum()
    assert np.abs(held[:, free] - weight[free]).max() < imbalance
    assert run.numerics["max_penetration"] < 1e-10
    # a residual in every step adds up to g dt times it, over 2 s
    assert np.abs(run.position - run.position[0]).max() < TOLERANCE * G * 1e-3 * 2.0 * 10.0


def _incline(make_structure, slope, n=1):
    angle = np.arctan(slope)
    bodies = [{"name": f"b{i}", "shape": "squat", "position": [0.0, 0.0, 0.25 + 0.5 * i]} for i in range(n)]
    gravity = [G * np.sin(angle), 0.0, -G * np.cos(angle)]
    shapes = {**SHAPES, "slab": {"box": [300.0, 3.0, 0.2]}}
    structure = make_structure(bodies, friction=MU, gravity=gravity, shapes=shapes)
    return structure, G * (np.sin(angle) - MU * np.cos(angle))


@pytest.mark.parametrize("n", [1, 2])
def test_half_a_percent_below_the_limit_it_stays_for_two_minutes(n, make_structure, run_nscd):
    """Coulomb: tan(angle) < mu holds for ever; each joint is as near to its limit as the other."""
    structure, _ = _incline(make_structure, 0.995 * MU, n)
    run = run_nscd(structure, 120.0, rate=1)
    # no spring, so no stretch; the residual of 120,000 steps at most
    assert np.abs(run.position - run.position[0]).max() < 1e-9
    assert run.energy[-1, 3] < 1e-6


def test_half_a_percent_above_it_slides_for_a_minute(make_structure, run_nscd):
    """Acceleration g (sin - mu cos), 0.022 m/s2, as exactly at the end as at the start."""
    structure, acceleration = _incline(make_structure, 1.005 * MU)
    run = run_nscd(structure, 60.0, rate=1)
    assert run.status == "completed"
    # the residual is relative to the weight, of which the acceleration is 0.22 %
    np.testing.assert_allclose(run.velocity[1:, 1, 0], acceleration * run.time[1:], rtol=1e3 * TOLERANCE)
    gone = run.position[-1, 1, 0] - run.position[0, 1, 0]
    assert gone == pytest.approx(0.5 * acceleration * 60.0**2, rel=1e3 * TOLERANCE)
    weight = structure.mass[1] * G * np.cos(np.arctan(1.005 * MU))
    assert run.energy[-1, 3] == pytest.approx(MU * weight * gone, rel=1e3 * TOLERANCE)
