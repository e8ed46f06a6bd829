import numpy as np
import pytest
from contact_problems import dense, random_problem, slow_reference

from blockshake.solvers.nscd.gauss_seidel import sweep_into
from blockshake.solvers.nscd.newton import solve_linear_into
from blockshake.solvers.nscd.solver import solve_contacts_into

TOLERANCE = 1e-10


@pytest.mark.parametrize("seed", range(6))
def test_velocities_match_a_slow_reference(seed):
    rng = np.random.default_rng(seed)
    mu = 0.3
    bodies, inertia, inverse, contacts, v = random_problem(rng, 3, 4, mu)
    J, M_inverse = dense(bodies, inverse, contacts)
    p = slow_reference(J @ M_inverse @ J.T, J @ v.ravel(), mu)
    expected = v.ravel() + M_inverse @ J.T @ p
    _, residual = solve_contacts_into(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 5000, v)
    assert residual <= TOLERANCE
    # the reference stops at changes of 1e-13 with steps a hundred times shorter than the answer needs
    np.testing.assert_allclose(v.ravel(), expected, atol=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_contact_law_holds_on_crowded_problems(seed):
    rng = np.random.default_rng(100 + seed)
    mu = 0.6
    bodies, inertia, inverse, contacts, v = random_problem(rng, 4, 14, mu)
    free = v.ravel().copy()
    J, M_inverse = dense(bodies, inverse, contacts)
    _, residual = solve_contacts_into(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 20000, v)
    assert residual <= TOLERANCE
    p = contacts.impulse.ravel()
    np.testing.assert_allclose(v.ravel(), free + M_inverse @ J.T @ p, atol=1e-10)
    u, p = (J @ v.ravel()).reshape(-1, 3), p.reshape(-1, 3)
    near = 1e-7 * np.abs(p).max()
    assert p[:, 0].min() >= 0.0
    assert u[:, 0].min() > -near
    assert np.abs(p[:, 0] * u[:, 0]).max() < near
    friction, slide = np.linalg.norm(p[:, 1:], axis=1), np.linalg.norm(u[:, 1:], axis=1)
    assert (friction <= mu * p[:, 0] + near).all()
    # maximal dissipation: sliding contacts carry mu p_n against their slip
    assert np.abs(slide * mu * p[:, 0] + (p[:, 1:] * u[:, 1:]).sum(axis=1)).max() < near


def test_sweeps_alone_reach_the_same_velocities():
    rng = np.random.default_rng(7)
    bodies, inertia, inverse, contacts, v = random_problem(rng, 3, 4, 0.3)
    swept = v.copy()
    solve_contacts_into(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 5000, v)
    contacts.impulse[:] = 0.0
    for sweep in range(4000):
        sweep_into(bodies, inverse, contacts, sweep % 2 == 0, swept)
    np.testing.assert_allclose(swept, v, atol=1e-8)


def test_elimination_solves_banded_and_full_systems():
    rng = np.random.default_rng(3)
    for band in (2, 30):
        K = rng.normal(size=(30, 30))
        K[np.abs(np.subtract.outer(np.arange(30), np.arange(30))) > band] = 0.0
        x = rng.normal(size=30)
        right = K @ x
        assert solve_linear_into(K.copy(), right)
        np.testing.assert_allclose(right, x, rtol=1e-9, atol=1e-9)
    assert not solve_linear_into(np.zeros((3, 3)), np.ones(3))
