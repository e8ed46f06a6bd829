import numpy as np
import pytest
from contact_problems import assert_contact_law, dense, random_problem, slow_reference, solve_contacts

from blockshake.jit import kernel
from blockshake.solvers.nscd.solve.block_elimination import block_system, find_block, solve_blocks_into
from blockshake.solvers.nscd.solve.gauss_seidel import sweep_into
from blockshake.solvers.nscd.solve.newton import joins, newton_space

# compiled
solve_blocks_into = kernel(solve_blocks_into)
sweep_into = kernel(sweep_into)

TOLERANCE = 1e-10


@pytest.mark.parametrize("seed", range(6))
def test_velocities_match_a_slow_reference(seed):
    rng = np.random.default_rng(seed)
    mu = 0.3
    bodies, inertia, inverse, contacts, v = random_problem(rng, 3, 4, mu)
    J, M_inverse = dense(bodies, inverse, contacts)
    p = slow_reference(J @ M_inverse @ J.T, J @ v.ravel(), mu)
    expected = v.ravel() + M_inverse @ J.T @ p
    _, residual = solve_contacts(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 5000, v)
    assert residual <= TOLERANCE
    # the reference stops at changes of 1e-13 with steps a hundred times shorter than the answer needs
    np.testing.assert_allclose(v.ravel(), expected, atol=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_contact_law_holds_on_crowded_problems(seed):
    bodies, inertia, inverse, contacts, v = random_problem(np.random.default_rng(100 + seed), 4, 14, 0.6)
    free = v.copy()
    _, residual = solve_contacts(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 20000, v)
    assert residual <= TOLERANCE
    assert_contact_law(bodies, inverse, contacts, free, v, 1e3 * TOLERANCE)


def test_sweeps_alone_reach_the_same_velocities():
    rng = np.random.default_rng(7)
    bodies, inertia, inverse, contacts, v = random_problem(rng, 3, 4, 0.3)
    swept = v.copy()
    solve_contacts(bodies, inertia, inverse, contacts, 1e-9, TOLERANCE, 5000, v)
    contacts.impulse[:] = 0.0
    for sweep in range(4000):
        sweep_into(bodies, inverse, contacts, sweep % 2 == 0, swept)
    np.testing.assert_allclose(swept, v, atol=1e-8)


@pytest.mark.parametrize("n_pairs", [0, 19, 60])
def test_elimination_of_touching_bodies_gives_the_dense_answer(n_pairs):
    """Random unsymmetric blocks against NumPy's dense solution; 60 pairs of 20 bodies fill in."""
    rng = np.random.default_rng(n_pairs)
    pairs = np.array(
        [sorted(rng.choice(21, 2, replace=False)) for _ in range(n_pairs)], dtype=np.int64
    ).reshape(-1, 2)
    driven = np.arange(21) == 5
    system = block_system(driven, pairs[:, 0].copy(), pairs[:, 1].copy())
    assert sorted(system.rank) == list(range(-1, 20))
    for part in (system.diagonal, system.right_of, system.below):
        part[:] = 0.0
    K = np.zeros((20, 6, 20, 6))
    for k in range(20):
        # a small corner, so that rows must be exchanged within the block
        K[k, :, k] = system.diagonal[k] = rng.normal(size=(6, 6)) + 8.0 * np.eye(6) * (np.arange(6) > 0)
    for i, j in {tuple(sorted(system.rank[pair])) for pair in pairs}:
        if i >= 0:
            block = find_block(system, i, j)
            assert system.column[block] == j
            K[i, :, j], K[j, :, i] = rng.normal(size=(2, 6, 6))
            system.right_of[block], system.below[block] = K[i, :, j], K[j, :, i].T
    K = K.reshape(120, 120)
    x = rng.normal(size=120)
    system.x[:] = (K @ x).reshape(20, 6)
    assert solve_blocks_into(system)
    # rounding times the condition number and the growth without exchanges between blocks
    np.testing.assert_allclose(system.x.ravel(), x, atol=1e-13 * np.linalg.cond(K))


def test_a_singular_block_is_told():
    system = block_system(np.zeros(1, bool), np.empty(0, np.int64), np.empty(0, np.int64))
    system.diagonal[:], system.x[:] = 0.0, 1.0
    assert not solve_blocks_into(system)


def test_elimination_of_a_lattice_fills_in_little():
    """Minimum degree: a square of 30 x 30 keeps 31/4 n log2 n entries (George 1973) at most, not n sqrt n."""
    place = np.arange(900).reshape(30, 30)
    a = np.concatenate([place[:-1].ravel(), place[:, :-1].ravel()])
    b = np.concatenate([place[1:].ravel(), place[:, 1:].ravel()])
    system = block_system(np.zeros(900, bool), a, b)
    assert len(system.column) < 12_000


def test_a_work_space_serves_contacts_that_join_the_same_bodies():
    """Other contacts, fewer, or the same in another order have other entries in the system."""
    driven, a, b = np.arange(4) == 0, np.array([0, 1, 2]), np.array([1, 2, 3])
    newton = newton_space(driven, a, b)
    assert joins(newton, a.copy(), b.copy())
    assert not joins(newton, a[:2], b[:2])
    assert not joins(newton, a[[1, 0, 2]], b[[1, 0, 2]])
    assert not joins(newton, a, np.array([1, 3, 3]))
