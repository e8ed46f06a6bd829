"""The contact law of a step on hyperstatic and degenerate problems, against slow references in NumPy."""

import numpy as np
import pytest
from contact_problems import (
    assert_contact_law,
    dense,
    random_problem,
    slow_reference,
    solve_contacts,
    step_problem,
)
from scipy.optimize import nnls

from blockshake.geometry.structure import load_structure
from blockshake.solvers.nscd.contact.contacts import contact_velocities_into, delassus_into
from blockshake.solvers.nscd.solve.gauss_seidel import relative_residual

G, DT = 9.81, 1e-3
TOLERANCE = 1e-10
SHAPES = {
    "leg": {"box": [0.2, 0.2, 0.8]},
    "plate": {"box": [2.0, 2.0, 0.1]},
    "brick": {"box": [0.5, 0.3, 0.2]},
}


def table(scene, friction):
    """A plate on four legs, and one leg more under its middle: one support more than a plane needs, and more."""
    places = [(0.8, 0.8), (-0.8, 0.8), (0.8, -0.8), (-0.8, -0.8), (0.0, 0.0)]
    legs = [{"name": f"leg{i}", "shape": "leg", "position": [x, y, 0.4]} for i, (x, y) in enumerate(places)]
    plate = {"name": "plate", "shape": "plate", "position": [0, 0, 0.85]}
    return scene(SHAPES, [*legs, plate], friction=friction)


def wall(scene, friction):
    """Three courses in running bond: every brick stands on two, side by side with its neighbours."""
    bodies = [
        {"name": f"b{row}{i}", "shape": "brick", "position": [0.5 * i + 0.25 * (row % 2), 0, 0.1 + 0.2 * row]}
        for row in range(3)
        for i in range(4 - row % 2)
    ]
    return scene(SHAPES, bodies, friction=friction)


def shipped(number):
    """A shipped configuration with the same friction in all of its joints."""

    def make(_, friction):
        name = f"configuration-{number}"
        laws = load_structure(name).file.friction
        return load_structure(name, {f"friction.{'.'.join(law.pair)}": friction for law in laws})

    return make


HYPERSTATIC = {"table": table, "wall": wall, "configuration-3": shipped(3), "configuration-4": shipped(4)}


def falling(structure, seed, scale):
    """A step of gravity, and random velocities of ``scale`` times it."""
    v = np.zeros((len(structure.mass), 6))
    v[:, 2] = -G * DT
    return v + scale * G * DT * np.random.default_rng(seed).normal(size=v.shape)


def solve(problem, iterations=100_000):
    """Impulses from nothing, which takes far more iterations than a step that starts from the one before."""
    bodies, inertia, inverse, contacts, v = problem
    return solve_contacts(bodies, inertia, inverse, contacts, 1e-12, TOLERANCE, iterations, v)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [0.0, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("name", HYPERSTATIC)
def test_contact_law_holds_in_redundant_supports(name, friction, scale, seed, scene):
    structure = HYPERSTATIC[name](scene, friction)
    problem = step_problem(structure, falling(structure, seed, scale))
    free = problem[4].copy()
    _, residual = solve(problem)
    assert residual <= TOLERANCE
    bodies, _, inverse, contacts, v = problem
    # each contact's part of the relative residual, times the root of their number
    assert_contact_law(bodies, inverse, contacts, free, v, 100.0 * TOLERANCE)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", HYPERSTATIC)
def test_without_friction_the_velocities_are_those_of_least_squares(name, seed, scene):
    """Gauss's principle: the impulses minimise kinetic energy, p >= 0; velocities are unique, impulses are not."""
    structure = HYPERSTATIC[name](scene, 0.0)
    problem = step_problem(structure, falling(structure, seed, 1.0))
    bodies, _, inverse, contacts, v = problem
    free = v.ravel().copy()
    J, M_inverse = dense(bodies, inverse, contacts)
    # M^-1/2 of block-diagonal M
    w, Q = np.linalg.eigh(M_inverse)
    root = Q @ np.diag(np.sqrt(np.maximum(w, 0.0))) @ Q.T
    unroot = Q @ np.diag(np.where(w > 1e-12 * w.max(), 1.0 / np.sqrt(np.maximum(w, 1e-300)), 0.0)) @ Q.T
    normal = J[::3]
    p, _ = nnls(root @ normal.T, -unroot @ free, maxiter=10_000)
    solve(problem)
    np.testing.assert_allclose(v.ravel(), free + M_inverse @ normal.T @ p, atol=1e-8 * G * DT)


@pytest.mark.parametrize("seed", range(4))
def test_the_slow_references_answer_is_one_of_the_solvers(seed, scene):
    """Eight points carry one sliding beam: how they share it is free, and turns its friction; so no one velocity.

    The reference's impulses are taken for an answer, and left as they are.
    """
    posts = [
        {"name": f"p{i}", "shape": "leg", "position": [x, 0, 0.4], "driven": True}
        for i, x in enumerate((-0.7, 0.7))
    ]
    structure = scene(
        SHAPES, [*posts, {"name": "beam", "shape": "plate", "position": [0, 0, 0.85]}], friction=0.3
    )
    problem = step_problem(structure, falling(structure, seed, 0.5))
    bodies, inertia, inverse, contacts, v = problem
    assert len(contacts.gap) == 8
    free = v.ravel().copy()
    J, M_inverse = dense(bodies, inverse, contacts)
    p = slow_reference(J @ M_inverse @ J.T, J @ free, 0.3)
    expected = free + M_inverse @ J.T @ p
    # it slides
    assert np.abs(expected[18:20]).max() > 1e-3 * G * DT
    contacts.impulse[:] = p.reshape(-1, 3)
    iterations, residual = solve_contacts(bodies, inertia, inverse, contacts, 1e-12, 1e-8, 10, v)
    # the reference stops at changes of 1e-13 with thousands of steps still to go
    assert residual < 1e-8
    assert iterations <= 2
    np.testing.assert_allclose(v.ravel(), expected, atol=1e-7 * G * DT)
    np.testing.assert_allclose(contacts.impulse.ravel(), p, atol=1e-5 * p.max())


@pytest.mark.parametrize("seed", range(4))
def test_contacts_that_stand_twice_share_and_change_nothing(seed):
    rng = np.random.default_rng(seed)
    bodies, inertia, inverse, contacts, v = random_problem(rng, 4, 6, 0.3)
    twice = type(contacts)(*(np.concatenate([part, part]) for part in contacts))
    w = v.copy()
    free = v.copy()
    solve((bodies, inertia, inverse, contacts, v))
    _, residual = solve((bodies, inertia, inverse, twice, w))
    assert residual <= TOLERANCE
    np.testing.assert_allclose(w, v, atol=1e-7)
    assert_contact_law(bodies, inverse, twice, free, w, 100.0 * TOLERANCE)


def test_bodies_that_part_or_rest_are_left_alone(scene):
    structure = table(scene, 0.5)
    for velocity in (np.zeros(6), np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])):
        v = np.tile(velocity, (len(structure.mass), 1))
        # the legs part from the floor, the plate goes with them
        problem = step_problem(structure, v)
        before = problem[4].copy()
        iterations, residual = solve(problem)
        assert residual == 0.0
        assert iterations <= 1
        np.testing.assert_array_equal(problem[4], before)


@pytest.mark.parametrize("ratio", [1e-4, 1e4])
def test_unlike_masses_converge(ratio, scene):
    """A heavy brick on a light one, and a light one on a heavy one, ten thousand times."""
    bodies = [
        {"name": "low", "shape": "brick", "position": [0, 0, 0.1]},
        {"name": "high", "shape": "brick", "position": [0.05, 0, 0.3], "density": 2400.0 * ratio},
    ]
    structure = scene(SHAPES, bodies, friction=0.6)
    problem = step_problem(structure, falling(structure, 0, 0.2))
    free = problem[4].copy()
    _, residual = solve(problem)
    assert residual <= TOLERANCE
    bodies, _, inverse, contacts, v = problem
    assert_contact_law(bodies, inverse, contacts, free, v, 1e4 * TOLERANCE)


def test_a_body_that_is_crushed_is_told_and_not_hidden():
    """Two driven walls close on a body: the law has no answer, and the residual states it within the iterations."""
    rng = np.random.default_rng(3)
    bodies, inertia, inverse, contacts, v = random_problem(rng, 2, 2, 0.0)
    contacts.body_a[:], contacts.body_b[:] = 0, 1
    contacts.arm_a[:] = contacts.arm_b[:] = 0.0
    contacts.basis[:, 0] = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    contacts.shift[:, 0] = -1.0
    delassus_into(bodies, inverse, contacts)
    v[:] = 0.0
    iterations, residual = solve((bodies, inertia, inverse, contacts, v), iterations=300)
    assert iterations == 300
    assert residual > 1e-3 or contacts.impulse.max() > 1e3
    assert np.isfinite(v).all()


@pytest.mark.parametrize("cap", [3, 104])
@pytest.mark.parametrize("n_bodies", [2, 120])
def test_the_cap_ends_the_search_with_the_best_answer_met(n_bodies, cap):
    """A crushed body has no answer; 104 ends among the sweeps, and 120 bodies stand for structures of any size."""
    rng = np.random.default_rng(3)
    bodies, inertia, inverse, contacts, v = random_problem(rng, n_bodies, 2, 0.0)
    contacts.body_a[:], contacts.body_b[:] = 0, 1
    contacts.arm_a[:] = contacts.arm_b[:] = 0.0
    contacts.basis[:, 0] = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    contacts.shift[:, 0] = -1.0
    delassus_into(bodies, inverse, contacts)
    v[:] = 0.0
    free = v.copy()
    iterations, residual = solve((bodies, inertia, inverse, contacts, v), iterations=cap)
    assert iterations == cap
    # the residual told is that of the impulses and velocities handed back, which belong together
    u = np.empty(contacts.impulse.shape)
    contact_velocities_into(contacts, v, u)
    assert residual == relative_residual(contacts, u, 1e-12)
    J, M_inverse = dense(bodies, inverse, contacts)
    expected = free.ravel() + M_inverse @ J.T @ contacts.impulse.ravel()
    np.testing.assert_allclose(v.ravel(), expected, rtol=1e-12, atol=1e-12 * np.abs(contacts.impulse).max())
