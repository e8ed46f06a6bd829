"""Velocities at contacts, the residual of the contact law, and sweeps of nonlinear Gauss-Seidel (NLGS)."""

import numpy as np

from blockshake.jit import borrowing_kernel
from blockshake.solvers.nscd.contact.contacts import W_11, W_22, W_N1, W_N2, W_NN, effective_mass
from blockshake.solvers.nscd.contact.friction import coefficient_along
from blockshake.solvers.nscd.solve.local_solve import contact_residual, solve_contact
from blockshake.solvers.vectors import add_impulse_into, cross, matrix_product, transposed_product


@borrowing_kernel
def relative_velocity(contacts, contact, v):
    """Velocity of b minus that of a at a contact, along its basis [m/s].

    ``v`` (n_bodies, 6): velocity [m/s] and angular velocity [rad/s] of the bodies, world frame.
    """
    a, b = v[contacts.body_a[contact]], v[contacts.body_b[contact]]
    r, s = contacts.arm_a[contact], contacts.arm_b[contact]
    x = b[0] + b[4] * s[2] - b[5] * s[1] - a[0] - a[4] * r[2] + a[5] * r[1]
    y = b[1] + b[5] * s[0] - b[3] * s[2] - a[1] - a[5] * r[0] + a[3] * r[2]
    z = b[2] + b[3] * s[1] - b[4] * s[0] - a[2] - a[3] * r[1] + a[4] * r[0]
    return matrix_product(contacts.basis[contact], (x, y, z))


@borrowing_kernel
def contact_velocities_into(contacts, v, u):
    """Velocities of all contacts along their bases [m/s], into ``u`` (n_contacts, 3); ``v`` as there."""
    for contact in range(contacts.gap.size):
        u[contact, 0], u[contact, 1], u[contact, 2] = relative_velocity(contacts, contact, v)


@borrowing_kernel
def _push_into(v, arm, inverse_mass, inverse_inertia, sign, impulse):
    """Velocity of one body after ``sign`` times an impulse [N s] at ``arm`` from its mass centre."""
    spin = matrix_product(inverse_inertia, cross(arm, impulse))
    for axis in range(3):
        v[axis] += sign * inverse_mass * impulse[axis]
        v[3 + axis] += sign * spin[axis]


@borrowing_kernel
def apply_impulses_into(bodies, inverse_inertia, contacts, v_free, v):
    """Overwrite ``v`` with ``v_free`` and the effect of all impulses."""
    v[:] = 0.0
    for contact in range(contacts.gap.size):
        world = transposed_product(contacts.basis[contact], contacts.impulse[contact])
        add_impulse_into(-1.0, world, contacts.arm_a[contact], v[contacts.body_a[contact]])
        add_impulse_into(1.0, world, contacts.arm_b[contact], v[contacts.body_b[contact]])
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            for i in range(6):
                v[body, i] = v_free[body, i]
            continue
        spin = matrix_product(inverse_inertia[body], v[body, 3:])
        for axis in range(3):
            v[body, axis] = v_free[body, axis] + bodies.inverse_mass[body] * v[body, axis]
            v[body, 3 + axis] = v_free[body, 3 + axis] + spin[axis]


@borrowing_kernel
def law_velocity(contacts, contact, u):
    """Velocity that the law is written in: a contact's ``u`` and its shifts, compliance in the normal [m/s]."""
    shift = contacts.shift[contact]
    u_n = (
        contacts.share[contact] * (u[0] + shift[0])
        + contacts.compliance[contact] * contacts.impulse[contact, 0]
    )
    return u_n, u[1] + shift[1], u[2] + shift[2]


@borrowing_kernel
def relative_residual(contacts, u, floor):
    """Residual of the contact law, relative to the impulses [1].

    Root of the summed squares of `contact_residual` over all contacts, divided by that of the
    impulses or by ``floor`` [N s], whichever is larger. ``u`` (n_contacts, 3): as from `contact_velocities_into`.
    """
    left, load = 0.0, 0.0
    for contact in range(contacts.gap.size):
        p, rho = contacts.impulse[contact], effective_mass(contacts.delassus[contact])
        u_n, u_1, u_2 = law_velocity(contacts, contact, u[contact])
        mu = coefficient_along(contacts, contact, p[1] - rho * u_1, p[2] - rho * u_2)
        part = contact_residual(p[0], p[1], p[2], u_n, u_1, u_2, mu, rho)
        left += part * part
        load += p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    return np.sqrt(left) / max(np.sqrt(load), floor)


@borrowing_kernel
def sweep_into(bodies, inverse_inertia, contacts, upwards, v):
    """One sweep of NLGS: the local problem of every contact in turn, first to last if ``upwards``, else back.

    Parameters
    ----------
    bodies : Bodies
    inverse_inertia : float64 array, shape (n_bodies, 3, 3)
        World frame [1/(kg m2)].
    contacts : Contacts
        ``impulse`` is changed.
    upwards : bool
    v : float64 array, shape (n_bodies, 6)
        Velocities at the end of the step, kept in line with the impulses.
    """
    n_contacts = contacts.gap.size
    for rank in range(n_contacts):
        contact = rank if upwards else n_contacts - 1 - rank
        u_n, u_1, u_2 = law_velocity(contacts, contact, relative_velocity(contacts, contact, v))
        p, w = contacts.impulse[contact], contacts.delassus[contact]
        q_n = u_n - (w[W_NN] * p[0] + w[W_N1] * p[1] + w[W_N2] * p[2])
        q_1 = u_1 - (w[W_N1] * p[0] + w[W_11] * p[1])
        q_2 = u_2 - (w[W_N2] * p[0] + w[W_22] * p[2])
        rho = effective_mass(w)
        mu = coefficient_along(contacts, contact, p[1] - rho * u_1, p[2] - rho * u_2)
        p_n, p_1, p_2, slip_ratio = solve_contact(
            w[W_NN], w[W_11], w[W_22], w[W_N1], w[W_N2], q_n, q_1, q_2, mu, contacts.slip_ratio[contact]
        )
        change = p_n - p[0], p_1 - p[1], p_2 - p[2]
        if change[0] != 0.0 or change[1] != 0.0 or change[2] != 0.0:
            world = transposed_product(contacts.basis[contact], change)
            a, b = contacts.body_a[contact], contacts.body_b[contact]
            _push_into(v[b], contacts.arm_b[contact], bodies.inverse_mass[b], inverse_inertia[b], 1.0, world)
            if not bodies.driven[a]:
                _push_into(
                    v[a], contacts.arm_a[contact], bodies.inverse_mass[a], inverse_inertia[a], -1.0, world
                )
            p[0], p[1], p[2] = p_n, p_1, p_2
            contacts.slip_ratio[contact] = slip_ratio
