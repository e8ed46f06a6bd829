import numpy as np
import pytest

from blockshake.solvers.nscd.solve.gauss_seidel import contact_residual, solve_contact

# the local answer is exact but for rounding, which the condition of the random operators (below 1e4) enlarges
ROUNDING = 1e-10


def random_operator(rng):
    root = rng.normal(size=(3, 3)) + np.diag([1.0, 1.0, 1.0])
    W = root @ root.T + 0.05 * np.eye(3)
    angle = 0.5 * np.arctan2(2.0 * W[1, 2], W[1, 1] - W[2, 2])
    turn = np.array([[1, 0, 0], [0, np.cos(angle), np.sin(angle)], [0, -np.sin(angle), np.cos(angle)]])
    return turn @ W @ turn.T


def solve(W, q, mu):
    *p, slip = solve_contact(W[0, 0], W[1, 1], W[2, 2], W[0, 1], W[0, 2], *q, mu, 0.0)
    return np.array(p), slip


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.75, 3.0])
def test_complementarity_and_coulomb_hold_on_random_problems(mu):
    rng = np.random.default_rng(1)
    states = set()
    for _ in range(500):
        W, q = random_operator(rng), rng.normal(size=3) * 10.0 ** rng.uniform(-3, 3)
        p, _ = solve(W, q, mu)
        u = W @ p + q
        size = np.linalg.norm(q)
        assert p[0] >= 0.0
        if p[0] == 0.0 and not p.any():
            states.add("open")
            assert u[0] >= 0.0
            continue
        assert abs(u[0]) < ROUNDING * size
        friction, slide = np.linalg.norm(p[1:]), np.linalg.norm(u[1:])
        assert friction <= mu * p[0] + ROUNDING * np.linalg.norm(p)
        if slide > ROUNDING * size:
            states.add("slip")
            assert friction == pytest.approx(mu * p[0], rel=1e-8, abs=1e-14)
            assert p[1:] @ u[1:] == pytest.approx(-friction * slide, rel=1e-8, abs=1e-14)
        else:
            states.add("stick")
    assert states == ({"open", "slip"} if mu <= 0.1 else {"open", "stick", "slip"})


@pytest.mark.parametrize(
    "q", [(0.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1e-300, 1.0, 0.0), (1.0, 5.0, 5.0)]
)
def test_degenerate_velocities_give_finite_impulses(q):
    p, slip = solve(np.diag([2.0, 1.0, 1.0]), q, 0.5)
    assert np.isfinite(p).all()
    assert np.isfinite(slip)


def test_residual_is_zero_on_the_law_and_grows_off_it():
    rng = np.random.default_rng(2)
    for _ in range(200):
        W, q = random_operator(rng), rng.normal(size=3)
        p, _ = solve(W, q, 0.6)
        u = W @ p + q
        assert contact_residual(*p, *u, 0.6, 0.7) < ROUNDING
        p[2] += 0.3
        assert contact_residual(*p, *(W @ p + q), 0.6, 0.7) > 1e-3


def test_residual_of_a_closing_contact_is_the_impulse_that_is_missing():
    # De Saxce and Feng (1998): without impulse, u_n = -1 m/s and rho = 2 kg project to 2 N s
    assert contact_residual(0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.5, 2.0) == 2.0
    assert contact_residual(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 2.0) == 0.0
