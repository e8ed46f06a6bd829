"""Free flight of an asymmetric top through the whole solver: Euler's equations in elliptic functions."""

import numpy as np
from scipy.spatial.transform import Rotation
from tumbling_theory import EDGES, SPIN, elliptic, thrown

STEPS = np.array([4e-4, 2e-4, 1e-4, 5e-5])


def test_a_thrown_brick_tumbles_by_the_elliptic_solution_to_second_order(make_structure, run_ls_dem):
    structure = make_structure([thrown()], shapes=EDGES, gravity=[0.0, 0.0, 0.0])
    inertia = np.diag(structure.inertia[1])
    assert (np.diff(inertia) > 0.0).all()
    errors, energy_errors, momentum_errors = [], [], []
    for dt in STEPS:
        run = run_ls_dem(structure, 2.0, time_step=dt, rate=100)
        turn = Rotation.from_quat(run.orientation[:, 1], scalar_first=True)
        in_body = turn.inv().apply(run.angular_velocity[:, 1])
        errors.append(np.abs(in_body - elliptic(inertia, SPIN, run.time)).max())
        momentum = turn.apply(in_body * inertia)
        momentum_errors.append(np.abs(momentum - momentum[0]).max() / np.abs(momentum[0]).max())
        energy_errors.append(np.abs(run.energy[:, 0] / run.energy[0, 0] - 1.0).max())
    # a phase wrong by no more than (|w| dt)^2 of the 18 rad turned, times the polhode's 0.4 rad/s; an order of
    # magnitude, the order in dt is the test
    assert errors[-1] < (9.0 * STEPS[-1]) ** 2 * 18.0 * 0.4
    for found in (errors, energy_errors):
        np.testing.assert_allclose(np.log2(np.divide(found[:-1], found[1:])), 2.0, atol=0.1)
    # no force ever touches the angular momentum: rounding
    assert max(momentum_errors) < 1e-13
