import numpy as np
import pytest

from blockshake.dynamics.system import Bodies
from blockshake.solvers.nscd.contacts import empty_contacts, prepare_operators_into
from blockshake.solvers.nscd.gauss_seidel import sweep_into
from blockshake.solvers.nscd.newton import solve_linear_into
from blockshake.solvers.nscd.solver import solve_contacts_into

TOLERANCE = 1e-10


def random_problem(rng, n_bodies, n_contacts, mu):
    """Bodies at random places, body 0 fixed, and contacts between random pairs."""
    inverse = np.array([np.diag(rng.uniform(0.5, 2.0, 3)) for _ in range(n_bodies)])
    inverse[0] = 0.0
    inertia = np.array([np.eye(3)] + [np.linalg.inv(part) for part in inverse[1:]])
    mass = rng.uniform(0.5, 2.0, n_bodies)
    driven = np.arange(n_bodies) == 0
    bodies = Bodies(
        mass, inertia, np.where(driven, 0.0, 1.0 / mass), inverse, driven,
        np.zeros(3), np.zeros((n_bodies, 3)), np.zeros((n_bodies, 4)),
    )  # fmt: skip
    contacts = empty_contacts(n_contacts)
    for contact in range(n_contacts):
        a, b = sorted(rng.choice(n_bodies, 2, replace=False))
        contacts.body_a[contact], contacts.body_b[contact] = a, b
        normal = rng.normal(size=3)
        contacts.basis[contact, 0] = normal / np.linalg.norm(normal)
        contacts.arm_a[contact], contacts.arm_b[contact] = rng.normal(size=(2, 3))
        contacts.friction[contact] = mu
    prepare_operators_into(bodies, inverse, contacts)
    v = rng.normal(size=(n_bodies, 6))
    v[0] = 0.0
    return bodies, inertia, inverse, contacts, v


def dense(bodies, inverse, contacts):
    """Velocity of all contacts per velocity of the bodies, and per impulse."""
    n, n_bodies = len(contacts.gap), len(bodies.mass)
    J, M_inverse = np.zeros((3 * n, 6 * n_bodies)), np.zeros((6 * n_bodies, 6 * n_bodies))
    for body in range(n_bodies):
        M_inverse[6 * body : 6 * body + 3, 6 * body : 6 * body + 3] = bodies.inverse_mass[body] * np.eye(3)
        M_inverse[6 * body + 3 : 6 * body + 6, 6 * body + 3 : 6 * body + 6] = inverse[body]
    for contact in range(n):
        for sign, body, arm in (
            (-1.0, contacts.body_a[contact], contacts.arm_a[contact]),
            (1.0, contacts.body_b[contact], contacts.arm_b[contact]),
        ):
            for i, d in enumerate(contacts.basis[contact]):
                J[3 * contact + i, 6 * body : 6 * body + 6] += sign * np.concatenate([d, np.cross(arm, d)])
    return J, M_inverse


def slow_reference(W, q, mu):
    """Fixed point of De Saxce and Feng (1998): tiny steps of the natural map until nothing changes."""
    rho = 0.3 / np.linalg.eigvalsh(W).max()
    p = np.zeros_like(q)
    for _ in range(200_000):
        u = W @ p + q
        new = np.empty_like(p)
        for c in range(0, len(p), 3):
            s = p[c : c + 3] - rho * np.add(u[c : c + 3], [mu * np.hypot(u[c + 1], u[c + 2]), 0.0, 0.0])
            size = np.hypot(s[1], s[2])
            if size > mu * s[0]:
                along = max((s[0] + mu * size) / (1.0 + mu * mu), 0.0)
                s = np.array([along, *(mu * along / size * s[1:])])
            new[c : c + 3] = s
        if np.abs(new - p).max() < 1e-13:
            break
        p = new
    return p


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
