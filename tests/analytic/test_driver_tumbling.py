"""Free flight of an asymmetric top through the whole solver: Euler's equations in elliptic functions."""

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ellipj

SPIN = np.array([0.4, 0.0, 9.0])  # rad/s in body axes, about the axis of the largest inertia, nearly
EDGES = {"brick": {"box": [2.4, 1.6, 0.8]}}
STEPS = np.array([4e-4, 2e-4, 1e-4, 5e-5])


def _elliptic(inertia, spin, t):
    """Landau & Lifshitz, Mechanics, section 37; inertia ascending, spin about the second axis zero at t = 0."""
    a, b, c = inertia
    twice_energy, square = (inertia * spin**2).sum(), ((inertia * spin) ** 2).sum()
    assert square > twice_energy * b
    rate = np.sqrt((c - b) * (square - twice_energy * a) / (a * b * c))
    m = (b - a) * (twice_energy * c - square) / ((c - b) * (square - twice_energy * a))
    sn, cn, dn, _ = ellipj(rate * t, m)
    return np.column_stack(
        [
            np.sqrt((twice_energy * c - square) / (a * (c - a))) * cn,
            np.sqrt((twice_energy * c - square) / (b * (c - b))) * sn,
            np.sqrt((square - twice_energy * a) / (c * (c - a))) * dn,
        ]
    )


def test_a_thrown_brick_tumbles_by_the_elliptic_solution_to_second_order(make_structure, run_ls_dem):
    body = {
        "name": "b", "shape": "brick", "position": [0.0, 0.0, 50.0],
        "velocity": [1.0, 0.5, 3.0], "angular_velocity": list(SPIN),
    }  # fmt: skip
    structure = make_structure([body], shapes=EDGES, gravity=[0.0, 0.0, 0.0])
    inertia = np.diag(structure.inertia[1])
    assert (np.diff(inertia) > 0.0).all()
    errors, energy_errors, momentum_errors = [], [], []
    for dt in STEPS:
        run = run_ls_dem(structure, 2.0, time_step=dt, rate=100)
        turn = Rotation.from_quat(run.orientation[:, 1], scalar_first=True)
        in_body = turn.inv().apply(run.angular_velocity[:, 1])
        errors.append(np.abs(in_body - _elliptic(inertia, SPIN, run.time)).max())
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
