import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.solvers.ls_dem.parameters import LsDemParameters

SPEED = 0.1  # m/s, downwards; gravity off, so that the theory is a spring and a dashpot alone
STEP = 2e-6  # s


def _error(zeta, mass, area):
    """Error of a rebound ratio: the dashpot's force jumps in at contact, somewhere within a step.

    One step of that force at full speed is 2 zeta omega dt of the speed; the spring's part and the
    scheme are of second order, (omega dt)^2.
    """
    omega_dt = STEP * np.sqrt(LsDemParameters().normal_stiffness * area / mass)
    return 2.0 * zeta * omega_dt + 2.0 * omega_dt**2


def _rebound(zeta, pulling):
    """Rebound speed ratio of x'' + 2 zeta x' + x = 0, released at x = 0 (or where the force vanishes)."""

    def letting_go(_, y):
        return y[0] if pulling else y[0] + 2.0 * zeta * y[1]

    letting_go.terminal, letting_go.direction = True, 1.0
    # x < 0 inside; starts just inside so that the start is no event
    run = solve_ivp(
        lambda _, y: [y[1], -y[0] - 2.0 * zeta * y[1]],
        (0.0, 10.0), [-1e-12, -1.0], events=letting_go, rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    return run.y_events[0][0][1]


@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9])
def test_the_dashpot_of_equation_3_rebounds_with_c_res(restitution):
    """Zhou et al. (2023), Eq. (3) with (ln C)^2, after Tsuji et al. (1993): linear theory, pulling allowed."""
    assert _rebound(damping_ratio(restitution), pulling=True) == pytest.approx(restitution, rel=1e-8)


def test_the_ends_of_the_damping_ratio():
    assert damping_ratio(1.0) == 0.0
    assert damping_ratio(0.0) == 1.0
    assert damping_ratio(0.5) == pytest.approx(np.log(2.0) / np.sqrt(np.pi**2 + np.log(2.0) ** 2), rel=1e-15)


def test_the_theory_without_pulling_gives_0_5503():
    """Spring and dashpot of Eq. (3) that let go where the force vanishes: the theory of the runs below."""
    assert _rebound(damping_ratio(0.5), pulling=False) == pytest.approx(0.5503, abs=5e-5)


def _fall(make_structure, run_ls_dem, restitution, **parameters):
    body = {"name": "b", "shape": "block", "position": [0.0, 0.0, 0.8 + 1e-5], "velocity": [0.0, 0.0, -SPEED]}
    structure = make_structure([body], restitution=restitution, gravity=[0.0, 0.0, 0.0])
    run = run_ls_dem(structure, 0.01, time_step=STEP, **parameters)
    # straight up: nothing turned or went sideways
    assert np.abs(run.angular_velocity[-1]).max() < 1e-9
    assert np.abs(run.velocity[-1, 1, :2]).max() < 1e-9
    return run.velocity[-1, 1, 2] / SPEED


@pytest.mark.parametrize("spacing", [0.1, 0.2, 0.8])
@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_a_block_falling_flat_rebounds_by_the_theory(restitution, spacing, make_structure, run_ls_dem):
    """Eq. (2) without pulling on a face of 9 to 225 nodes: the interface's law, not the nodes'."""
    expected = _rebound(damping_ratio(restitution), pulling=False)
    found = _fall(make_structure, run_ls_dem, restitution, node_spacing=spacing)
    assert found == pytest.approx(expected, abs=_error(damping_ratio(restitution), 7364.0, 0.76 * 2.36))


def test_critical_damping_barely_rebounds(make_structure, run_ls_dem):
    """C_res = 0: zeta = 1; cut at zero it leaves exp(-2) of the speed where x + 2 x' = 0."""
    expected = _rebound(1.0, pulling=False)
    assert expected == pytest.approx(np.exp(-2.0), rel=1e-6)
    found = _fall(make_structure, run_ls_dem, 0.0)
    assert found == pytest.approx(expected, abs=_error(1.0, 7364.0, 0.76 * 2.36))


def test_two_free_bodies_exchange_momentum(make_structure, run_ls_dem):
    """Central impact of unlike masses in zero gravity: Newton's momentum and the same rebound ratio."""
    structure = make_structure(
        [
            {
                "name": "a",
                "shape": "cube",
                "position": [0.0, 0.0, 2.0],
                "velocity": [0.0, 0.0, SPEED],
                "density": 1000.0,
            },
            {"name": "b", "shape": "cube", "position": [0.0, 0.0, 3.00001]},
        ],
        gravity=[0.0, 0.0, 0.0],
    )
    run = run_ls_dem(structure, 0.01, time_step=STEP)
    momentum = (structure.mass[1:, None] * run.velocity[:, 1:]).sum(axis=1)
    # rounding: 1000 steps of 1e-16 of the momentum
    np.testing.assert_allclose(
        momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-13 * momentum[0, 2]
    )
    parting = run.velocity[-1, 2, 2] - run.velocity[-1, 1, 2]
    zeta = damping_ratio(0.5)
    mass = 1.0 / (1.0 / structure.mass[1] + 1.0 / structure.mass[2])
    assert parting / SPEED == pytest.approx(_rebound(zeta, pulling=False), abs=_error(zeta, mass, 1.0))


def test_an_oblique_spinning_impact_conserves_both_momenta(make_structure, run_ls_dem):
    """Newton's third law at every node: linear and angular momentum about the origin."""
    structure = make_structure(
        [
            {"name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.5, 0.2, 1.0]},
            {
                "name": "b", "shape": "block", "position": [0.3, 0.2, 3.5], "angular_velocity": [1.0, -0.5, 0.3],
                "orientation": [np.cos(0.1), np.sin(0.1), 0.0, 0.0],
            },
        ],
        gravity=[0.0, 0.0, 0.0],
    )  # fmt: skip
    run = run_ls_dem(structure, 0.4, time_step=5e-5, rate=100)
    assert len(run.joints) == 1  # they did meet
    q = run.orientation[:, 1:]
    spin = []
    for body in (1, 2):
        R = Rotation.from_quat(q[:, body - 1], scalar_first=True).as_matrix()
        spin.append(
            np.einsum("tij,jk,tlk,tl->ti", R, structure.inertia[body], R, run.angular_velocity[:, body])
        )
    linear = (structure.mass[1:, None] * run.velocity[:, 1:]).sum(axis=1)
    angular = sum(spin) + np.cross(run.position[:, 1:], structure.mass[1:, None] * run.velocity[:, 1:]).sum(
        axis=1
    )
    assert np.abs(run.velocity[-1, 1] - run.velocity[0, 1]).max() > 0.1
    scale = structure.mass[1] * 1.0
    np.testing.assert_allclose(linear, np.tile(linear[0], (len(linear), 1)), atol=1e-12 * scale)
    # the moment of a step's force about the origin is exact at full steps
    np.testing.assert_allclose(angular, np.tile(angular[0], (len(angular), 1)), atol=1e-11 * scale)
