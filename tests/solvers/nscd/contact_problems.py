"""Contact problems of one step: random ones, those of structures, and slow references for their answers."""

import numpy as np

from blockshake.dynamics.system import Bodies, assemble_bodies
from blockshake.geometry.rotations import rotation_matrices
from blockshake.jit import kernel
from blockshake.solvers.nscd.contact.contacts import delassus_into, detect_contacts, empty_contacts
from blockshake.solvers.nscd.contact.law import friction_into, ordered_friction
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, pack_polyhedra, place_into
from blockshake.solvers.nscd.progress import no_joints
from blockshake.solvers.nscd.solve.newton import newton_space
from blockshake.solvers.nscd.solve.solver import solve_contacts_into

# compiled
detect_contacts = kernel(detect_contacts)


@kernel
def solve_contacts(bodies, inertia, inverse, contacts, floor, tolerance, most, v):
    """`solve_contacts_into` with a work space of its own."""
    newton = newton_space(bodies.driven, contacts.body_a, contacts.body_b)
    return solve_contacts_into(bodies, inertia, inverse, contacts, floor, tolerance, most, v, newton)


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
    delassus_into(bodies, inverse, contacts)
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
    p = np.zeros((len(q) // 3, 3))
    for _ in range(400_000):
        u = (W @ p.ravel() + q).reshape(-1, 3)
        s = p - rho * u
        s[:, 0] -= rho * mu * np.hypot(u[:, 1], u[:, 2])
        size = np.hypot(s[:, 1], s[:, 2])
        outside = size > mu * s[:, 0]
        along = np.maximum((s[outside, 0] + mu * size[outside]) / (1.0 + mu * mu), 0.0)
        s[outside, 0] = along
        s[outside, 1:] *= (mu * along / np.maximum(size[outside], 1e-300))[:, None]
        change, p = np.abs(s - p).max(), s
        if change < 1e-13 * np.abs(p).max():
            break
    return p.ravel()


def step_problem(structure, v, margin=1e-4):
    """The contacts that the solver finds in a structure at its start, and velocities ``v`` before they act."""
    order = np.arange(len(structure.mass))
    bodies, state, _ = assemble_bodies(structure)
    polyhedra = pack_polyhedra(structure, order)
    placed = empty_placed(polyhedra)
    place_into(polyhedra, state.position, state.orientation, placed)
    R = rotation_matrices(state.orientation)
    inertia = np.ascontiguousarray(R @ bodies.inertia @ R.transpose(0, 2, 1))
    inverse = np.ascontiguousarray(R @ bodies.inverse_inertia @ R.transpose(0, 2, 1))
    faces = np.full((len(order), len(order)), -1, np.int64)
    layers = np.zeros((len(order), len(order)))
    contacts = detect_contacts(
        bodies, polyhedra, placed, np.ascontiguousarray(R), margin, 0.0, layers, 1.0, faces, 0
    )
    delassus_into(bodies, inverse, contacts)
    friction_into(
        ordered_friction(structure, order), no_joints(len(order)), np.ascontiguousarray(R), contacts
    )
    v = np.where(structure.driven[:, None], 0.0, v)
    return bodies, inertia, inverse, contacts, v


def assert_contact_law(bodies, inverse, contacts, free, v, tolerance):
    """Signorini, Coulomb's cone, maximal dissipation and Newton's law, in dense matrices."""
    J, M_inverse = dense(bodies, inverse, contacts)
    p = contacts.impulse.ravel()
    np.testing.assert_allclose(v.ravel(), free.ravel() + M_inverse @ J.T @ p, atol=tolerance)
    u, p = (J @ v.ravel()).reshape(-1, 3), p.reshape(-1, 3)
    # impulses and velocities are compared through the contacts' own masses
    size = np.abs(p).max()
    speed = size * contacts.delassus[:, :3].max(axis=1)
    assert p[:, 0].min() >= -tolerance * size
    assert (u[:, 0] > -tolerance * speed).all()
    assert (np.abs(p[:, 0] * u[:, 0]) < tolerance * size * speed).all()
    mu = contacts.friction
    friction, slide = np.linalg.norm(p[:, 1:], axis=1), np.linalg.norm(u[:, 1:], axis=1)
    assert (friction <= mu * p[:, 0] + tolerance * size).all()
    # sliding contacts carry mu p_n against their slip
    work = slide * mu * p[:, 0] + (p[:, 1:] * u[:, 1:]).sum(axis=1)
    assert (np.abs(work) < tolerance * size * speed).all()
