"""Bodies without a table: free flight by elliptic functions, and the momenta of impacts."""

import numpy as np
import pytest
from both_solvers import both, solve
from scipy.spatial.transform import Rotation
from scipy.special import ellipj

SPIN = np.array([0.4, 0.0, 9.0])  # rad/s in body axes, about the axis of the largest inertia, nearly
EDGES = {"brick": {"box": [2.4, 1.6, 0.8]}}
THROWN = {
    "name": "b", "shape": "brick", "position": [0.0, 0.0, 50.0],
    "velocity": [1.0, 0.5, 3.0], "angular_velocity": list(SPIN),
}  # fmt: skip
# two bodies that meet obliquely while one of them spins
MEETING = [
    {"name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.5, 0.2, 1.0]},
    {
        "name": "b", "shape": "block", "position": [0.3, 0.2, 3.5], "angular_velocity": [1.0, -0.5, 0.3],
        "orientation": [np.cos(0.1), np.sin(0.1), 0.0, 0.0],
    },
]  # fmt: skip
STEPS = {"ls-dem": np.array([4e-4, 2e-4, 1e-4, 5e-5]), "nscd": np.array([4e-3, 2e-3, 1e-3, 5e-4])}
G0 = [0.0, 0.0, 0.0]  # no gravity


def elliptic(inertia, spin, t):
    """Angular velocity in body axes [rad/s], (n, 3); inertia ascending, spin about the second axis zero at t = 0.

    Landau & Lifshitz, Mechanics, section 37.
    """
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


def momenta(structure, run):
    """Linear momentum, and angular momentum about the origin, of both bodies: (n_times, 3) each, over the first's."""
    assert len(run.joints) == 1  # they did meet
    assert np.abs(run.velocity[-1, 1] - run.velocity[0, 1]).max() > 0.1
    moved = structure.mass[1:, None] * run.velocity[:, 1:]
    angular = np.cross(run.position[:, 1:], moved).sum(axis=1)
    for body in (1, 2):
        R = Rotation.from_quat(run.orientation[:, body], scalar_first=True).as_matrix()
        angular += np.einsum(
            "tij,jk,tlk,tl->ti", R, structure.inertia[body], R, run.angular_velocity[:, body]
        )
    return moved.sum(axis=1) / structure.mass[1], angular / structure.mass[1]


@both
def test_a_thrown_brick_tumbles_by_the_elliptic_solution_to_second_order(solver, make_structure):
    """Second order in the angle, angular momentum to rounding; by Simo and Wong (1991) the energy of NSCD too."""
    structure = make_structure([THROWN], shapes=EDGES, gravity=G0)
    inertia = np.diag(structure.inertia[1])
    assert (np.diff(inertia) > 0.0).all()
    errors, energy_errors, momentum_errors = [], [], []
    for dt in STEPS[solver]:
        run = solve(solver, structure, np.arange(251) / 125.0, time_step=dt)
        turn = Rotation.from_quat(run.orientation[:, 1], scalar_first=True)
        in_body = turn.inv().apply(run.angular_velocity[:, 1])
        errors.append(np.abs(in_body - elliptic(inertia, SPIN, run.time)).max())
        momentum = turn.apply(in_body * inertia)
        momentum_errors.append(np.abs(momentum - momentum[0]).max() / np.abs(momentum[0]).max())
        energy_errors.append(np.abs(run.energy[:, 0] / run.energy[0, 0] - 1.0).max())
    # a phase wrong by no more than (|w| dt)^2 of the 18 rad turned, times the polhode's 0.4 rad/s; the order is tested
    assert errors[-1] < (9.0 * STEPS[solver][-1]) ** 2 * 18.0 * 0.4
    for found in (errors, energy_errors) if solver == "ls-dem" else (errors,):
        np.testing.assert_allclose(np.log2(np.divide(found[:-1], found[1:])), 2.0, atol=0.1)
    # no force ever touches the angular momentum; NSCD: rounding of the fixed-point iteration in up to 4,000 steps
    assert max(momentum_errors) < (1e-13 if solver == "ls-dem" else 1e-11)
    assert solver == "ls-dem" or max(energy_errors) < 1e-11


@pytest.mark.parametrize(("solver", "restitution"), [("ls-dem", 0.5), ("nscd", 0.0), ("nscd", 0.5)])
def test_an_oblique_spinning_impact_conserves_both_momenta(solver, restitution, make_structure):
    """Newton's third law at every contact: linear and angular momentum about the origin.

    LS-DEM: the moment of a step's force about the origin is exact at full steps. NSCD: an impulse acts at one point on
    both bodies, and the scheme's positions move with the mean of the velocities at theta 0.5. All to rounding.
    """
    key = "restitution" if solver == "ls-dem" else "nscd_restitution"
    structure = make_structure(MEETING, gravity=G0, **{key: restitution})
    run = solve(solver, structure, 0.4 if solver == "ls-dem" else 0.6)
    linear, angular = momenta(structure, run)
    np.testing.assert_allclose(linear - linear[0], 0.0, atol=1e-12 if solver == "ls-dem" else 1e-11)
    np.testing.assert_allclose(angular - angular[0], 0.0, atol=1e-11)
    if solver == "nscd":
        # what kinetic energy is gone is in the two dissipated terms, but for the fall of net work of a moment
        lost = run.energy[0, 0] - run.energy[:, 0]
        np.testing.assert_allclose(run.energy[:, 3:5].sum(axis=1), lost, atol=1e-4 * run.energy[0, 0])


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
def test_two_free_bodies_part_by_newtons_ratio(restitution, make_structure):
    """Central impact of unlike masses in NSCD: momentum kept, parting speed e times the approach."""
    lower = {"name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.0, 0.0, 0.4]}
    upper = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 3.05]}
    structure = make_structure(
        [{**lower, "density": 1000.0}, upper], gravity=G0, nscd_restitution=restitution
    )
    run = solve("nscd", structure, 0.5)
    momentum = (structure.mass[1:, None] * run.velocity[:, 1:]).sum(axis=1)
    np.testing.assert_allclose(momentum - momentum[0], 0.0, atol=1e-12 * momentum[0, 2])
    parting = run.velocity[-1, 2, 2] - run.velocity[-1, 1, 2]
    # the solver's tolerance
    assert parting == pytest.approx(restitution * 0.4, abs=1e-7 * 0.4)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_dropped_block_rebounds_by_newtons_ratio(restitution, make_structure):
    """Fall from h, speeds sqrt(2 g h) before and e times that after: the impact falls within a step of g dt."""
    g, h, dt = 9.81, 0.3, 1e-4
    body = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5 + h]}
    structure = make_structure([body], nscd_restitution=restitution)
    run = solve("nscd", structure, np.arange(261) / 1000.0, time_step=dt)
    fallen = np.sqrt(2.0 * g * h)
    landing = fallen / g
    late = run.time > landing + 2.0 * dt
    expected = restitution * fallen - g * (run.time[late] - landing) * (restitution > 0.0)
    np.testing.assert_allclose(run.velocity[late, 1, 2], expected, atol=2.0 * g * dt)
    assert run.position[:, 1, 2].min() > 0.5 - 1e-9
