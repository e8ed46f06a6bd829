"""NSCD without a table: free flight by elliptic functions, and the momenta of impacts."""

import numpy as np
import pytest
from oblique_impact import BODIES, momenta
from scipy.spatial.transform import Rotation
from tumbling_theory import EDGES, SPIN, elliptic, thrown

STEPS = np.array([4e-3, 2e-3, 1e-3, 5e-4])


def test_a_thrown_brick_tumbles_by_the_elliptic_solution_to_second_order(make_structure, run_nscd):
    """Simo and Wong (1991): second order in the angle, momentum and energy to rounding at any step."""
    structure = make_structure([thrown()], shapes=EDGES, gravity=[0.0, 0.0, 0.0])
    inertia = np.diag(structure.inertia[1])
    errors = []
    for dt in STEPS:
        run = run_nscd(structure, 2.0, time_step=dt, rate=125)
        turn = Rotation.from_quat(run.orientation[:, 1], scalar_first=True)
        in_body = turn.inv().apply(run.angular_velocity[:, 1])
        errors.append(np.abs(in_body - elliptic(inertia, SPIN, run.time)).max())
        momentum = turn.apply(in_body * inertia)
        # rounding of the fixed-point iteration in up to 4,000 steps
        assert np.abs(momentum - momentum[0]).max() < 1e-11 * np.abs(momentum[0]).max()
        assert np.abs(run.energy[:, 0] / run.energy[0, 0] - 1.0).max() < 1e-11
    # a phase wrong by (|w| dt)^2 of the 18 rad turned at most, times the polhode's 0.4 rad/s; the order is the test
    assert errors[-1] < (9.0 * STEPS[-1]) ** 2 * 18.0 * 0.4
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_an_oblique_spinning_impact_conserves_both_momenta(restitution, make_structure, run_nscd):
    """Newton's third law at every contact: linear and angular momentum about the origin.

    An impulse acts at one point on both bodies, and the scheme's positions move with the mean of the velocities at
    theta 0.5: both momenta are kept to rounding.
    """
    structure = make_structure(BODIES, gravity=[0.0, 0.0, 0.0], nscd_restitution=restitution)
    run = run_nscd(structure, 0.6)
    linear, angular = momenta(structure, run)
    np.testing.assert_allclose(linear - linear[0], 0.0, atol=1e-11)
    np.testing.assert_allclose(angular - angular[0], 0.0, atol=1e-11)
    # what kinetic energy is gone is in the two dissipated terms, but for the fall of net work of a moment
    lost = run.energy[0, 0] - run.energy[:, 0]
    np.testing.assert_allclose(run.energy[:, 3:5].sum(axis=1), lost, atol=1e-4 * run.energy[0, 0])


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
def test_two_free_bodies_part_by_newtons_ratio(restitution, make_structure, run_nscd):
    """Central impact of unlike masses: momentum kept, parting speed e times the approach."""
    bodies = [
        {
            "name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.0, 0.0, 0.4], "density": 1000.0
        },
        {"name": "b", "shape": "cube", "position": [0.0, 0.0, 3.05]},
    ]  # fmt: skip
    structure = make_structure(bodies, gravity=[0.0, 0.0, 0.0], nscd_restitution=restitution)
    run = run_nscd(structure, 0.5)
    momentum = (structure.mass[1:, None] * run.velocity[:, 1:]).sum(axis=1)
    np.testing.assert_allclose(
        momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-12 * momentum[0, 2]
    )
    parting = run.velocity[-1, 2, 2] - run.velocity[-1, 1, 2]
    # the solver's tolerance
    assert parting == pytest.approx(restitution * 0.4, abs=1e-7 * 0.4)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_dropped_block_rebounds_by_newtons_ratio(restitution, make_structure, run_nscd):
    """Fall from h, speeds sqrt(2 g h) before and e times that after: the impact falls within a step of g dt."""
    g, h, dt = 9.81, 0.3, 1e-4
    body = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5 + h]}
    run = run_nscd(make_structure([body], nscd_restitution=restitution), 0.26, time_step=dt, rate=1000)
    fallen = np.sqrt(2.0 * g * h)
    landing = fallen / g
    late = run.time > landing + 2.0 * dt
    expected = restitution * fallen - g * (run.time[late] - landing) * (restitution > 0.0)
    np.testing.assert_allclose(run.velocity[late, 1, 2], expected, atol=2.0 * g * dt)
    assert run.position[:, 1, 2].min() > 0.5 - 1e-9
