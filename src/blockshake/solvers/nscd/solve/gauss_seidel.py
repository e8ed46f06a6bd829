"""Signorini and Coulomb at one contact, solved exactly; nonlinear Gauss-Seidel sweeps over all contacts (NLGS)."""

import numpy as np

from blockshake.geometry.vectors import add_impulse_into, cross, matrix_product, transposed_product
from blockshake.jit import kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import (
    W_11,
    W_22,
    W_N1,
    W_N2,
    W_NN,
    effective_mass,
    relative_velocity,
)
from blockshake.solvers.nscd.contact.law import coefficient_along, law_velocity

_MAX_HALVINGS = 100
_ROOT = 1e-14  # relative width of the last bracket: rounding, so that the local answer is exact


@kernel_without_allocation
def solve_contact(w_n, w_1, w_2, a_1, a_2, q_n, q_1, q_2, mu, guess):
    """Impulse of one frictional contact that leaves the others as they are.

    Parameters
    ----------
    w_n, w_1, w_2, a_1, a_2 : float
        Delassus operator ``[[w_n, a_1, a_2], [a_1, w_1, 0], [a_2, 0, w_2]]`` [1/kg], positive
        definite; the tangents are chosen such that its lower right block is diagonal.
    q_n, q_1, q_2 : float
        Velocity of the contact without its own impulse [m/s].
    mu : float
        Coulomb's coefficient [1].
    guess : float
        ``slip_ratio`` of an earlier answer [1/kg], where the search starts; 0 for none.

    Returns
    -------
    p_n, p_1, p_2 : float
        Impulse [N s].
    slip_ratio : float
        Slip speed per friction impulse [1/kg]; 0 where the contact sticks or is open.

    Notes
    -----
    With velocity ``u = W p + q``: ``0 <= u_n, p_n`` with product zero, ``|p_t| <= mu p_n``, and
    ``u_t = -slip_ratio p_t`` with ``slip_ratio > 0`` only where ``|p_t| = mu p_n``. Open and stuck contacts
    are read off. For a slipping one, ``p`` follows from ``slip_ratio`` by a positive definite linear system, and
    ``|p_t| - mu p_n`` falls from positive (stick outside the cone) at ``slip_ratio = 0`` to negative at
    infinity, so that a root lies between: Newton's method, halving the bracket where it leaves it.
    """
    if q_n >= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    if mu == 0.0:
        return -q_n / w_n, 0.0, 0.0, 0.0
    p_n, p_1, p_2 = _impulse(w_n, w_1, w_2, a_1, a_2, q_n, q_1, q_2, 0.0)
    if p_n >= 0.0 and p_1 * p_1 + p_2 * p_2 <= mu * mu * p_n * p_n:
        return p_n, p_1, p_2, 0.0
    low, high = 0.0, np.inf
    slip_ratio = guess if guess > 0.0 else max(w_1, w_2)
    for _ in range(_MAX_HALVINGS):
        d_1, d_2 = 1.0 / (w_1 + slip_ratio), 1.0 / (w_2 + slip_ratio)
        schur = w_n - a_1 * a_1 * d_1 - a_2 * a_2 * d_2
        p_n = (-q_n + a_1 * q_1 * d_1 + a_2 * q_2 * d_2) / schur
        p_1, p_2 = -(a_1 * p_n + q_1) * d_1, -(a_2 * p_n + q_2) * d_2
        size = np.sqrt(p_1 * p_1 + p_2 * p_2)
        excess = size - mu * p_n
        if excess > 0.0:
            low = slip_ratio
        else:
            high = slip_ratio
        slope_n = -(a_1 * q_1 * d_1 * d_1 + a_2 * q_2 * d_2 * d_2)
        slope_n = (slope_n - p_n * (a_1 * a_1 * d_1 * d_1 + a_2 * a_2 * d_2 * d_2)) / schur
        slope = -mu * slope_n
        if size > 0.0:
            slope += (
                p_1 * (-a_1 * slope_n * d_1 - p_1 * d_1) + p_2 * (-a_2 * slope_n * d_2 - p_2 * d_2)
            ) / size
        following = slip_ratio - excess / slope if slope != 0.0 else -1.0
        if not (low < following < high):
            following = 0.5 * (low + high) if high < np.inf else 4.0 * slip_ratio
        if abs(following - slip_ratio) <= _ROOT * slip_ratio or excess == 0.0:
            break
        slip_ratio = following
    p_n, p_1, p_2 = _impulse(w_n, w_1, w_2, a_1, a_2, q_n, q_1, q_2, slip_ratio)
    return max(p_n, 0.0), p_1, p_2, slip_ratio


@kernel_without_allocation
def _impulse(w_n, w_1, w_2, a_1, a_2, q_n, q_1, q_2, slip_ratio):
    """Impulse with ``u_n = 0`` and ``u_t = -slip_ratio p_t``."""
    d_1, d_2 = 1.0 / (w_1 + slip_ratio), 1.0 / (w_2 + slip_ratio)
    p_n = (-q_n + a_1 * q_1 * d_1 + a_2 * q_2 * d_2) / (w_n - a_1 * a_1 * d_1 - a_2 * a_2 * d_2)
    return p_n, -(a_1 * p_n + q_1) * d_1, -(a_2 * p_n + q_2) * d_2


@kernel_without_allocation
def contact_residual(p_n, p_1, p_2, u_n, u_1, u_2, mu, rho):
    """Residual of the law at one contact, as an impulse [N s].

    ``|p - P_K(p - rho u~)|`` with the cone ``K`` of Coulomb and ``u~ = u + mu |u_t| n``, zero
    exactly where the law of `solve_contact` holds; De Saxce and Feng (1998), natural map as
    in Acary and Cadoux (2013). ``rho`` [kg] turns velocities into impulses.
    """
    s_n = p_n - rho * (u_n + mu * np.sqrt(u_1 * u_1 + u_2 * u_2))
    s_1, s_2 = p_1 - rho * u_1, p_2 - rho * u_2
    size = np.sqrt(s_1 * s_1 + s_2 * s_2)
    if size > mu * s_n or s_n < 0.0:
        # outside the cone: onto its surface, or onto the apex from the polar cone
        along = max((s_n + mu * size) / (1.0 + mu * mu), 0.0)
        scale = mu * along / size if size > 0.0 else 0.0
        s_n, s_1, s_2 = along, scale * s_1, scale * s_2
    d_n, d_1, d_2 = p_n - s_n, p_1 - s_1, p_2 - s_2
    return np.sqrt(d_n * d_n + d_1 * d_1 + d_2 * d_2)


@kernel_without_allocation
def _push_into(v, arm, inverse_mass, inverse_inertia, sign, impulse):
    """Velocity of one body after ``sign`` times an impulse [N s] at ``arm`` from its mass centre."""
    spin = matrix_product(inverse_inertia, cross(arm, impulse))
    for axis in range(3):
        v[axis] += sign * inverse_mass * impulse[axis]
        v[3 + axis] += sign * spin[axis]


@kernel_without_allocation
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


@kernel_without_allocation
def relative_residual(contacts, u, floor):
    """Residual of the contact law, relative to the impulses [1].

    Root of the summed squares of `contact_residual` over all contacts, divided by that of the
    impulses or by ``floor`` [N s], whichever is larger. ``u`` (n_contacts, 3): as from `contact_velocities_into`.
    """
    error, load = 0.0, 0.0
    for contact in range(contacts.gap.size):
        p, rho = contacts.impulse[contact], effective_mass(contacts.delassus[contact])
        u_n, u_1, u_2 = law_velocity(contacts, contact, u[contact])
        mu = coefficient_along(contacts, contact, p[1] - rho * u_1, p[2] - rho * u_2)
        part = contact_residual(p[0], p[1], p[2], u_n, u_1, u_2, mu, rho)
        error += part * part
        load += p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    return np.sqrt(error) / max(np.sqrt(load), floor)


@kernel_without_allocation
def sweep_into(bodies, inverse_inertia, contacts, upwards, v):
    """Sweep of NLGS: the local problem of every contact in turn is solved, first to last if ``upwards``, else back.

    ``contacts.impulse`` is changed, and ``v`` (n_bodies, 6), the velocities at the end of the step, is kept in line
    with it. ``inverse_inertia`` (n_bodies, 3, 3): world frame [1/(kg m2)].
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
