"""Nonsmooth Newton steps on all contacts at once, in the velocities of the bodies."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.vectors import add_impulse_into, cross, matrix_product, transposed_product
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import effective_mass, relative_velocity
from blockshake.solvers.nscd.contact.law import coefficient_along, law_velocity
from blockshake.solvers.nscd.solve.block_elimination import (
    BlockSystem,
    block_system,
    find_block,
    solve_blocks_into,
)
from blockshake.solvers.nscd.solve.gauss_seidel import apply_impulses_into


class NewtonSpace(NamedTuple):
    """Work space of the Newton steps of one time step, and of later ones as long as contacts join the same bodies.

    ``body_a``, ``body_b`` int64 (n_contacts,): those. ``system`` (BlockSystem): in the velocities of the free bodies.
    ``entry`` int64 (n_contacts,): where the bodies of a contact meet in it, -1 where one is driven. ``slope``
    (n_contacts, 3, 3) [kg] and ``offset`` (n_contacts, 3) [N s]: of the linear laws. ``columns`` (3, 6): of one contact
    and one body.
    """

    body_a: np.ndarray
    body_b: np.ndarray
    system: BlockSystem
    entry: np.ndarray
    slope: np.ndarray
    offset: np.ndarray
    columns: np.ndarray


@inner_kernel
def newton_space(driven, body_a, body_b):
    """Work space for the contacts of a step between these bodies."""
    n_contacts = body_a.size
    system = block_system(driven, body_a, body_b)
    entry = np.full(n_contacts, -1, np.int64)
    for contact in range(n_contacts):
        rank, other = system.rank[body_a[contact]], system.rank[body_b[contact]]
        if rank >= 0 and other >= 0:
            entry[contact] = find_block(system, min(rank, other), max(rank, other))
    return NewtonSpace(
        body_a,
        body_b,
        system,
        entry,
        np.empty((n_contacts, 3, 3)),
        np.empty((n_contacts, 3)),
        np.empty((3, 6)),
    )


@kernel_without_allocation
def joins(newton, body_a, body_b):
    """Whether a work space is for contacts that join these bodies, one by one."""
    if newton.body_a.size != body_a.size:
        return False
    for contact in range(body_a.size):
        if newton.body_a[contact] != body_a[contact] or newton.body_b[contact] != body_b[contact]:
            return False
    return True


@kernel_without_allocation
def linear_law_into(contacts, contact, u, stiffness, D, c):
    """Linear law ``p = c - D u`` of one contact, from its state and where that points.

    Parameters
    ----------
    contacts, contact, u : Contacts, int, three floats
        ``u``: velocity of the contact that belongs to its impulse, along its basis [m/s].
    stiffness : float
        Stiffness of the proximal term, in effective masses of the contact [1]: the error it leaves in the contact
        law is the change of the impulse divided by this.
    D, c : float64 arrays, shape (3, 3) and (3,)
        Overwritten, along the contact's basis [kg, N s].

    Notes
    -----
    States by the projection of Alart and Curnier (1991) with the contact's own effective mass.
    Open: no impulse. Sticking: ``p = p_old - r (u + shift)`` with a large ``r``, the proximal form of ``u +
    shift = 0``, which stays regular however many contacts share a load. Slipping: the normal
    part of that; friction ``mu p_n`` along the slip, and across it the linear part of ``-mu p_n u_t /
    |u_t|``, the coefficient taken for the direction at hand. A contact's compliance adds to ``1 / r``.
    """
    D[:] = 0.0
    c[:] = 0.0
    p, shift = contacts.impulse[contact], contacts.shift[contact]
    share, compliance = contacts.share[contact], contacts.compliance[contact]
    u_n, u_1, u_2 = law_velocity(contacts, contact, u)
    rho = effective_mass(contacts.delassus[contact])
    # Alart and Curnier: the contact is closed where the augmented impulse p_n - rho u_n is positive
    trial_n = p[0] - rho * u_n
    if trial_n <= 0.0:
        return
    stiff = stiffness * rho
    D[0, 0] = stiff * share / (1.0 + stiff * compliance)
    c[0] = (p[0] - stiff * share * shift[0]) / (1.0 + stiff * compliance)
    # augmented tangential impulse: inside Coulomb's disk the contact sticks, outside it slips along it
    s_1, s_2 = p[1] - rho * u_1, p[2] - rho * u_2
    mu = coefficient_along(contacts, contact, s_1, s_2)
    if mu == 0.0:
        return
    size = np.sqrt(s_1 * s_1 + s_2 * s_2)
    limit = mu * trial_n
    if size <= limit:
        D[1, 1] = D[2, 2] = stiff
        c[1], c[2] = p[1] - stiff * shift[1], p[2] - stiff * shift[2]
        return
    # slipping: derivative of the projection onto the disk, of radius mu p_n; its change with p_n is the coupling of
    # D[1, 0] and D[2, 0], which makes the system unsymmetric
    d_1, d_2 = s_1 / size, s_2 / size
    across = min(rho * limit / (size - limit), stiff)
    D[1, 0], D[2, 0] = mu * d_1 * D[0, 0], mu * d_2 * D[0, 0]
    D[1, 1], D[1, 2] = across * d_2 * d_2, -across * d_1 * d_2
    D[2, 1], D[2, 2] = -across * d_1 * d_2, across * d_1 * d_1
    c[1] = mu * d_1 * c[0] - D[1, 1] * shift[1] - D[1, 2] * shift[2]
    c[2] = mu * d_2 * c[0] - D[2, 1] * shift[1] - D[2, 2] * shift[2]


@kernel_without_allocation
def _columns_into(slope, transposed, basis, arm, T):
    """Impulse [N s] of a contact on its second body, world frame, per velocity of a body at ``arm``: (3, 6).

    With ``transposed`` the slope of the linear law is transposed.
    """
    for i in range(3):
        T[i, 0] = T[i, 1] = T[i, 2] = 0.0
    for i in range(3):
        for j in range(3):
            d = slope[j, i] if transposed else slope[i, j]
            if d != 0.0:
                for k in range(3):
                    for m in range(3):
                        T[k, m] += d * basis[i, k] * basis[j, m]
    for i in range(3):
        T[i, 3], T[i, 4], T[i, 5] = cross(arm, T[i])


@kernel_without_allocation
def _add_block_into(sign, arm, T, block):
    """Add force and moment about the mass centre, at ``arm``, of the columns ``T``."""
    for j in range(6):
        x, y, z = sign * T[0, j], sign * T[1, j], sign * T[2, j]
        block[0, j] += x
        block[1, j] += y
        block[2, j] += z
        block[3, j] += arm[1] * z - arm[2] * y
        block[4, j] += arm[2] * x - arm[0] * z
        block[5, j] += arm[0] * y - arm[1] * x


@kernel_without_allocation
def _add_contact_into(contacts, contact, slope, entry, system, T):
    """Add the linear law of one contact, closed, to the matrix."""
    basis = contacts.basis[contact]
    first, first_arm = system.rank[contacts.body_a[contact]], contacts.arm_a[contact]
    then, then_arm = system.rank[contacts.body_b[contact]], contacts.arm_b[contact]
    if first > then:
        first, first_arm, then, then_arm = then, then_arm, first, first_arm
    _columns_into(slope, False, basis, then_arm, T)
    _add_block_into(1.0, then_arm, T, system.diagonal[then])
    if first < 0:
        return
    _add_block_into(-1.0, first_arm, T, system.right_of[entry])
    _columns_into(slope, True, basis, then_arm, T)
    _add_block_into(-1.0, first_arm, T, system.below[entry])
    _columns_into(slope, False, basis, first_arm, T)
    _add_block_into(1.0, first_arm, T, system.diagonal[first])


@kernel_without_allocation
def _assemble_into(bodies, inertia, contacts, stiffness, v, newton):
    """Linear laws of all contacts, and the system that they give."""
    system = newton.system
    system.diagonal[:] = 0.0
    system.right_of[:] = 0.0
    system.below[:] = 0.0
    system.x[:] = 0.0
    T = newton.columns
    for body in range(system.rank.size):
        rank = system.rank[body]
        if rank >= 0:
            for i in range(3):
                system.diagonal[rank, i, i] = bodies.mass[body]
                for j in range(3):
                    system.diagonal[rank, 3 + i, 3 + j] = inertia[body, i, j]
    for contact in range(contacts.gap.size):
        D, c, p = newton.slope[contact], newton.offset[contact], contacts.impulse[contact]
        u = relative_velocity(contacts, contact, v)
        linear_law_into(contacts, contact, u, stiffness, D, c)
        # laws in the change of the velocity, so that the answer is small where the step has converged
        due = matrix_product(D, u)
        c[0], c[1], c[2] = c[0] - due[0], c[1] - due[1], c[2] - due[2]
        change = transposed_product(contacts.basis[contact], (c[0] - p[0], c[1] - p[1], c[2] - p[2]))
        a, b = system.rank[contacts.body_a[contact]], system.rank[contacts.body_b[contact]]
        if a >= 0:
            add_impulse_into(-1.0, change, contacts.arm_a[contact], system.x[a])
        if b >= 0:
            add_impulse_into(1.0, change, contacts.arm_b[contact], system.x[b])
        if D[0, 0] > 0.0:
            _add_contact_into(contacts, contact, D, newton.entry[contact], system, T)


@kernel_without_allocation
def newton_step_into(bodies, inertia, inverse_inertia, contacts, stiffness, v_free, v, newton):
    """Replace impulses, and velocities with them, by those of one Newton step; False where the system is singular.

    Parameters
    ----------
    bodies, inertia, inverse_inertia, contacts : Bodies, float64 arrays, shape (n_bodies, 3, 3), Contacts
        Inertia in the world frame [kg m2, 1/(kg m2)]. ``contacts.impulse`` is changed.
    stiffness : float
        As in `linear_law_into`.
    v_free, v : float64 arrays, shape (n_bodies, 6)
        Velocities without contact impulses; ``v`` with them, before, and overwritten with those after.
    newton : NewtonSpace
        Overwritten.

    Notes
    -----
    ``(M + J^T D J) dv = J^T (c - D u - p)`` with the linear laws of `linear_law_into`. Nothing but ``newton`` is
    changed where the system is singular.
    """
    system = newton.system
    _assemble_into(bodies, inertia, contacts, stiffness, v, newton)
    if not solve_blocks_into(system):
        return False
    # the change of the velocities, until the impulses give the velocities themselves
    for body in range(system.rank.size):
        rank = system.rank[body]
        for i in range(6):
            v[body, i] = system.x[rank, i] if rank >= 0 else 0.0
    for contact in range(contacts.gap.size):
        c, p = newton.offset[contact], contacts.impulse[contact]
        due = matrix_product(newton.slope[contact], relative_velocity(contacts, contact, v))
        p[0], p[1], p[2] = c[0] - due[0], c[1] - due[1], c[2] - due[2]
    apply_impulses_into(bodies, inverse_inertia, contacts, v_free, v)
    return True
