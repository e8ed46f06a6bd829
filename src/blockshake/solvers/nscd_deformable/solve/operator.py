"""Velocities of contacts that impulses cause, through rigid motion and through deformation."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.vectors import copy_into, cross, dot, matrix_product, put_into, transposed_product
from blockshake.jit import inner_kernel, kernel_without_aliasing, kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import W_11, W_22, W_N1, W_N2, W_NN, relative_velocity
from blockshake.solvers.nscd.solve.gauss_seidel import apply_impulses_into
from blockshake.solvers.nscd_deformable.contact_points import anchored
from blockshake.solvers.nscd_deformable.elastic_step import compliance_of


class Problem(NamedTuple):
    """One step's contact problem but for the contacts themselves.

    ``inverse_inertia`` (n_bodies, 3, 3): world frame [1/(kg m2)]; ``rotations`` (n_bodies, 3, 3), body to world;
    ``v_free`` (n_bodies, 6) and ``point_free`` (n_active, 3): velocities of the bodies, world frame, and of the
    lattice's points that carry contact, body frames, at the end of the step without contact; ``bodies``, ``response``,
    ``anchors``: Bodies, ElasticResponse of `at_anchors`, Anchors.
    """

    bodies: tuple
    response: tuple
    anchors: tuple
    inverse_inertia: np.ndarray
    rotations: np.ndarray
    v_free: np.ndarray
    point_free: np.ndarray


class ContactMotion(NamedTuple):
    """Velocities that belong to the impulses.

    ``v`` (n_bodies, 6); ``forces`` and ``points`` (n_active, 3): impulses on the lattice's points that carry contact
    and their velocities, body frames; ``u`` (n_contacts, 3): of the contacts, along their bases [m/s].
    """

    v: np.ndarray
    forces: np.ndarray
    points: np.ndarray
    u: np.ndarray


@inner_kernel
def empty_motion(n_bodies, n_points, n_contacts):
    """Arrays for the velocities of so many bodies, lattice points and contacts."""
    return ContactMotion(
        np.empty((n_bodies, 6)), np.empty((n_points, 3)), np.empty((n_points, 3)), np.empty((n_contacts, 3))
    )


@kernel_without_allocation
def impulses_on_points_into(anchors, rotations, contacts, forces):
    """Share the contacts' impulses out to the lattice's points, body frames."""
    forces[:] = 0.0
    for contact in range(contacts.gap.size):
        world = transposed_product(contacts.basis[contact], contacts.impulse[contact])
        for side in range(2):
            body = contacts.body_b[contact] if side else contacts.body_a[contact]
            sign = 1.0 if side else -1.0
            inward = transposed_product(rotations[body], world)
            for corner in range(4):
                weight = sign * anchors.weights[contact, side, corner]
                if weight != 0.0:
                    force = forces[anchors.points[contact, side, corner]]
                    for axis in range(3):
                        force[axis] += weight * inward[axis]


@kernel_without_allocation
def elastic_velocity(anchors, rotations, contacts, contact, points):
    """Velocity of b's surface minus that of a's by deformation, along the contact's basis [m/s]."""
    R_a, R_b = rotations[contacts.body_a[contact]], rotations[contacts.body_b[contact]]
    of_a = matrix_product(R_a, anchored(anchors, contact, 0, points))
    of_b = matrix_product(R_b, anchored(anchors, contact, 1, points))
    return matrix_product(contacts.basis[contact], (of_b[0] - of_a[0], of_b[1] - of_a[1], of_b[2] - of_a[2]))


@kernel_without_aliasing
def add_times_into(row, factor, x):
    """Add ``factor`` times ``row`` to ``x``, both (n,)."""
    for i in range(x.size):
        x[i] += factor * row[i]


@kernel_without_allocation
def velocities_into(problem, contacts, motion):
    """Velocities that the contacts' impulses give: the exact operator, without a matrix for all contacts."""
    bodies, anchors = problem.bodies, problem.anchors
    apply_impulses_into(bodies, problem.inverse_inertia, contacts, problem.v_free, motion.v)
    impulses_on_points_into(anchors, problem.rotations, contacts, motion.forces)
    copy_into(problem.point_free, motion.points)
    velocities, forces = motion.points.reshape(-1), motion.forces.reshape(-1)
    for body in range(bodies.mass.size):
        first, last = 3 * anchors.first[body], 3 * anchors.first[body + 1]
        C = compliance_of(anchors.first, problem.response, body)
        for source in range(first, last):
            if forces[source] != 0.0:
                # the compliance is symmetric: its rows are its columns
                add_times_into(C[source - first], forces[source], velocities[first:last])
    surface_velocities_into(anchors, problem.rotations, contacts, motion.v, motion.points, motion.u)


@kernel_without_allocation
def surface_velocities_into(anchors, rotations, contacts, v, points, u):
    """Velocities ``u`` (n_contacts, 3) of the contacts, for those of the bodies, ``v``, and of the lattices' points."""
    for contact in range(contacts.gap.size):
        rigid = relative_velocity(contacts, contact, v)
        elastic = elastic_velocity(anchors, rotations, contacts, contact, points)
        for axis in range(3):
            u[contact, axis] = rigid[axis] + elastic[axis]


@kernel_without_allocation
def _point_rows_into(problem, contacts, contact, side, G):
    """Velocity of the lattice points of a contact's body, along the contact's basis, per impulse: ``G`` (3, 3 n)."""
    anchors = problem.anchors
    body = contacts.body_b[contact] if side else contacts.body_a[contact]
    C, first = compliance_of(anchors.first, problem.response, body), anchors.first[body]
    basis, R = contacts.basis[contact], problem.rotations[body]
    for i in range(3):
        G[i, : C.shape[0]] = 0.0
    for corner in range(4):
        weight = anchors.weights[contact, side, corner]
        if weight == 0.0:
            continue
        source = 3 * (anchors.points[contact, side, corner] - first)
        for i in range(3):
            direction = transposed_product(R, basis[i])
            for axis in range(3):
                factor = weight * direction[axis]
                if factor != 0.0:
                    add_times_into(C[source + axis], factor, G[i, : C.shape[0]])


@kernel_without_allocation
def _levers_into(contacts, contact, side, lever):
    """Moments about the mass centre of unit impulses along a contact's basis: rows of ``lever`` (3, 3) [m]."""
    arm = contacts.arm_b[contact] if side else contacts.arm_a[contact]
    for i in range(3):
        put_into(cross(arm, contacts.basis[contact, i]), lever[i])


@kernel_without_allocation
def _add_block_into(problem, contacts, contact, side, G, lever, other, other_side, block):
    """Add the effect of contact ``other``'s impulse on contact ``contact``'s velocity through a body of both."""
    sign = 1.0 if side == other_side else -1.0
    anchors = problem.anchors
    body = contacts.body_b[contact] if side else contacts.body_a[contact]
    arm = contacts.arm_b[other] if other_side else contacts.arm_a[other]
    inverse_mass = problem.bodies.inverse_mass[body]
    first, R, inertia = anchors.first[body], problem.rotations[body], problem.inverse_inertia[body]
    for j in range(3):
        along = contacts.basis[other, j]
        spin = matrix_product(inertia, cross(arm, along))
        inward = transposed_product(R, along)
        for i in range(3):
            w = inverse_mass * dot(contacts.basis[contact, i], along) + dot(lever[i], spin)
            for corner in range(4):
                weight = anchors.weights[other, other_side, corner]
                if weight != 0.0:
                    at = 3 * (anchors.points[other, other_side, corner] - first)
                    w += weight * (G[i, at] * inward[0] + G[i, at + 1] * inward[1] + G[i, at + 2] * inward[2])
            block[i, j] += sign * w


@kernel_without_allocation
def _own_operators_into(problem, contacts, lever, held, W):
    """`own_operators_into` with three arrays to work in."""
    anchors = problem.anchors
    for contact in range(contacts.gap.size):
        basis = contacts.basis[contact]
        W[:] = 0.0
        for side in range(2):
            body = contacts.body_b[contact] if side else contacts.body_a[contact]
            C, first = compliance_of(anchors.first, problem.response, body), anchors.first[body]
            held[:] = 0.0
            for corner in range(4):
                for other in range(4):
                    weight = anchors.weights[contact, side, corner] * anchors.weights[contact, side, other]
                    if weight != 0.0:
                        row = 3 * (anchors.points[contact, side, corner] - first)
                        column = 3 * (anchors.points[contact, side, other] - first)
                        for k in range(3):
                            for m in range(3):
                                held[k, m] += weight * C[row + k, column + m]
            _levers_into(contacts, contact, side, lever)
            for j in range(3):
                spin = matrix_product(problem.inverse_inertia[body], lever[j])
                answer = matrix_product(held, transposed_product(problem.rotations[body], basis[j]))
                W[j, j] += problem.bodies.inverse_mass[body]
                for i in range(3):
                    inward = transposed_product(problem.rotations[body], basis[i])
                    W[i, j] += dot(lever[i], spin) + dot(inward, answer)
        w = contacts.delassus[contact]
        w[W_NN] = contacts.share[contact] * W[0, 0] + contacts.compliance[contact]
        w[W_11], w[W_22], w[W_N1], w[W_N2] = W[1, 1], W[2, 2], W[0, 1], W[0, 2]


@inner_kernel
def own_operators_into(problem, contacts):
    """Fill in ``contacts.delassus``: what each contact's velocity makes of its own impulse."""
    _own_operators_into(problem, contacts, np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)))


class Operator(NamedTuple):
    """Velocity of contacts per impulse of each other, as far as it has been requested in a step.

    ``known`` bool (n_contacts,): contacts in it. ``last`` int64 (n_contacts,): the last contact that each, or one
    before it, shares a body with. ``matrix`` (3 n_contacts, 3 n_contacts): zero where contacts are not coupled [1/kg].
    """

    known: np.ndarray
    last: np.ndarray
    matrix: np.ndarray


@inner_kernel
def empty_operator(problem, contacts):
    """Operator that knows no contact yet, but which of them are coupled."""
    n, driven = contacts.gap.size, problem.bodies.driven
    of_body, last = np.full(driven.size, -1, np.int64), np.arange(n)
    for contact in range(n):
        of_body[contacts.body_a[contact]] = of_body[contacts.body_b[contact]] = contact
    for contact in range(n):
        if contact:
            last[contact] = max(contact, last[contact - 1])
        for body in (contacts.body_a[contact], contacts.body_b[contact]):
            if not driven[body]:
                last[contact] = max(last[contact], of_body[body])
    return Operator(np.zeros(n, np.bool_), last, np.zeros((3 * n, 3 * n)))


@kernel_without_allocation
def _extend_into(problem, contacts, wanted, operator, G_a, G_b, block, lever_a, lever_b):
    """`extend_into` with arrays to work in."""
    driven, n = problem.bodies.driven, contacts.gap.size
    known, W = operator.known, operator.matrix
    for contact in range(n):
        if not wanted[contact] or known[contact]:
            continue
        known[contact] = True
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        _point_rows_into(problem, contacts, contact, 0, G_a)
        _point_rows_into(problem, contacts, contact, 1, G_b)
        _levers_into(contacts, contact, 0, lever_a)
        _levers_into(contacts, contact, 1, lever_b)
        for other in range(n):
            c, d = contacts.body_a[other], contacts.body_b[other]
            if not known[other] or (a not in (c, d) and b not in (c, d)):
                continue
            block[:] = 0.0
            if not driven[a] and a in (c, d):
                _add_block_into(problem, contacts, contact, 0, G_a, lever_a, other, 0 if a == c else 1, block)
            if not driven[b] and b in (c, d):
                _add_block_into(problem, contacts, contact, 1, G_b, lever_b, other, 0 if b == c else 1, block)
            for i in range(3):
                for j in range(3):
                    W[3 * contact + i, 3 * other + j] = block[i, j]
                    W[3 * other + j, 3 * contact + i] = block[i, j]


@inner_kernel
def extend_into(problem, contacts, wanted, operator):
    """Bring the contacts that are ``wanted``, bool (n_contacts,), into the operator."""
    first, widest = problem.anchors.first, 0
    for body in range(first.size - 1):
        widest = max(widest, 3 * (first[body + 1] - first[body]))
    G_a, G_b, block = np.empty((3, widest)), np.empty((3, widest)), np.empty((3, 3))
    lever_a, lever_b = np.empty((3, 3)), np.empty((3, 3))
    _extend_into(problem, contacts, wanted, operator, G_a, G_b, block, lever_a, lever_b)
