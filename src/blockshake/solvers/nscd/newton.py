"""Nonsmooth Newton steps on all contacts at once, in the velocities of the bodies."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.nscd.friction import coefficient_along
from blockshake.solvers.nscd.gauss_seidel import apply_impulse_into, relative_velocity


@kernel
def linear_law_into(contacts, contact, v, stiffness, D, c):
    """Linear law ``p = c - D u`` of one contact, from its state and where that points.

    Parameters
    ----------
    contacts : Contacts
    contact : int
    v : float64 array, shape (n_bodies, 6)
        Velocities that belong to the impulses of ``contacts``.
    stiffness : float
        Of the proximal term, in effective masses of the contact [1]: the error it leaves in the contact
        law is the change of the impulse divided by this.
    D : float64 array, shape (3, 3)
        Overwritten [kg], along the contact's basis.
    c : float64 array, shape (3,)
        Overwritten [N s].

    Notes
    -----
    States by the projection of Alart and Curnier (1991) with the contact's own effective mass.
    Open: no impulse. Sticking: ``p = p_old - r (u + bound)`` with a large ``r``, the proximal form of ``u +
    bound = 0``, which stays regular however many contacts share a load. Slipping: the normal
    part of that; friction ``mu p_n`` along the slip, and across it the linear part of ``-mu p_n u_t /
    |u_t|``, the coefficient taken for the direction at hand. A stopper's compliance adds to ``1 / r``.
    """
    D[:] = 0.0
    c[:] = 0.0
    p, bound, local = contacts.impulse[contact], contacts.bound[contact], contacts.local[contact]
    compliance = contacts.compliance[contact]
    u_n, u_1, u_2 = relative_velocity(contacts, contact, v)
    u_n, u_1, u_2 = u_n + bound[0] + compliance * p[0], u_1 + bound[1], u_2 + bound[2]
    rho = 1.0 / max(local[0], max(local[1], local[2]))
    trial_n = p[0] - rho * u_n
    if trial_n <= 0.0:
        return
    stiff = stiffness * rho
    D[0, 0] = stiff / (1.0 + stiff * compliance)
    c[0] = (p[0] - stiff * bound[0]) / (1.0 + stiff * compliance)
    s_1, s_2 = p[1] - rho * u_1, p[2] - rho * u_2
    mu = coefficient_along(contacts, contact, s_1, s_2)
    if mu == 0.0:
        return
    size = np.sqrt(s_1 * s_1 + s_2 * s_2)
    limit = mu * trial_n
    if size <= limit:
        D[1, 1] = D[2, 2] = stiff
        c[1], c[2] = p[1] - stiff * bound[1], p[2] - stiff * bound[2]
        return
    d_1, d_2 = s_1 / size, s_2 / size
    across = min(rho * limit / (size - limit), stiff)
    D[1, 0], D[2, 0] = mu * d_1 * D[0, 0], mu * d_2 * D[0, 0]
    D[1, 1], D[1, 2] = across * d_2 * d_2, -across * d_1 * d_2
    D[2, 1], D[2, 2] = -across * d_1 * d_2, across * d_1 * d_1
    c[1] = mu * d_1 * c[0] - D[1, 1] * bound[1] - D[1, 2] * bound[2]
    c[2] = mu * d_2 * c[0] - D[2, 1] * bound[1] - D[2, 2] * bound[2]


@kernel
def _rows_into(basis, arm, sign, J):
    """Velocity of a contact point along the basis, per velocity of its body: (3, 6)."""
    for i in range(3):
        d = basis[i]
        J[i, 0], J[i, 1], J[i, 2] = sign * d[0], sign * d[1], sign * d[2]
        J[i, 3] = sign * (arm[1] * d[2] - arm[2] * d[1])
        J[i, 4] = sign * (arm[2] * d[0] - arm[0] * d[2])
        J[i, 5] = sign * (arm[0] * d[1] - arm[1] * d[0])


@kernel
def _add_block_into(J_row, D, J_column, row, column, K):
    """Add ``J_row^T D J_column`` to the block of ``K`` that starts at (row, column)."""
    for j in range(6):
        x = D[0, 0] * J_column[0, j] + D[0, 1] * J_column[1, j] + D[0, 2] * J_column[2, j]
        y = D[1, 0] * J_column[0, j] + D[1, 1] * J_column[1, j] + D[1, 2] * J_column[2, j]
        z = D[2, 0] * J_column[0, j] + D[2, 1] * J_column[1, j] + D[2, 2] * J_column[2, j]
        for i in range(6):
            K[row + i, column + j] += J_row[0, i] * x + J_row[1, i] * y + J_row[2, i] * z


@kernel
def solve_linear_into(K, x):
    """Solve ``K y = x`` by elimination with row exchanges; ``x`` becomes ``y``, ``K`` is lost.

    Rows that hold zero in the column at hand are skipped, which keeps the cost of a stack, whose
    matrix is banded, near linear. False where ``K`` is singular.
    """
    n = x.size
    reach = np.empty(n, np.int64)
    for i in range(n):
        reach[i] = n - 1
        while reach[i] > 0 and K[i, reach[i]] == 0.0:
            reach[i] -= 1
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(K[i, k]) > abs(K[pivot, k]):
                pivot = i
        if not abs(K[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for j in range(k, n):
                K[k, j], K[pivot, j] = K[pivot, j], K[k, j]
            x[k], x[pivot] = x[pivot], x[k]
            reach[k], reach[pivot] = reach[pivot], reach[k]
        row_k = K[k]
        for i in range(k + 1, n):
            if K[i, k] == 0.0:
                continue
            row_i = K[i]
            factor = row_i[k] / row_k[k]
            for j in range(k + 1, reach[k] + 1):
                row_i[j] -= factor * row_k[j]
            x[i] -= factor * x[k]
            reach[i] = max(reach[i], reach[k])
    for k in range(n - 1, -1, -1):
        total = x[k]
        for j in range(k + 1, reach[k] + 1):
            total -= K[k, j] * x[j]
        x[k] = total / K[k, k]
    return True


@kernel
def newton_step_into(bodies, inertia, inverse_inertia, row_of, contacts, stiffness, v_free, v):
    """Replace the impulses by those of one Newton step, inside Coulomb's cone, and the velocities with them.

    Parameters
    ----------
    bodies : Bodies
    inertia, inverse_inertia : float64 arrays, shape (n_bodies, 3, 3)
        World frame [kg m2, 1/(kg m2)].
    row_of : int64 array, shape (n_bodies,)
        First unknown of each body, -1 for driven ones.
    contacts : Contacts
        ``impulse`` is changed.
    stiffness : float
        As in `linear_law_into`.
    v_free, v : float64 arrays, shape (n_bodies, 6)
        Velocities without contact impulses; ``v`` with them, before and after.

    Returns
    -------
    bool
        False, with nothing changed, where the linear system is singular.

    Notes
    -----
    ``(M + J^T D J) dv = J^T (c - D u - p)`` with the linear laws of `linear_law_into`.
    """
    n_contacts = contacts.gap.size
    n = row_of.max() + 6
    K, x = np.zeros((n, n)), np.zeros(n)
    laws, offsets = np.empty((n_contacts, 3, 3)), np.empty((n_contacts, 3))
    J_a, J_b = np.empty((3, 6)), np.empty((3, 6))
    for body in range(row_of.size):
        row = row_of[body]
        if row >= 0:
            for i in range(3):
                K[row + i, row + i] = bodies.mass[body]
                for j in range(3):
                    K[row + 3 + i, row + 3 + j] = inertia[body, i, j]
    for contact in range(n_contacts):
        D, c = laws[contact], offsets[contact]
        linear_law_into(contacts, contact, v, stiffness, D, c)
        u_n, u_1, u_2 = relative_velocity(contacts, contact, v)
        for i in range(3):
            c[i] -= D[i, 0] * u_n + D[i, 1] * u_1 + D[i, 2] * u_2
        p = contacts.impulse[contact]
        row_a, row_b = row_of[contacts.body_a[contact]], row_of[contacts.body_b[contact]]
        _rows_into(contacts.basis[contact], contacts.arm_a[contact], -1.0, J_a)
        _rows_into(contacts.basis[contact], contacts.arm_b[contact], 1.0, J_b)
        if row_a >= 0:
            for j in range(6):
                for i in range(3):
                    x[row_a + j] += J_a[i, j] * (c[i] - p[i])
            if D[0, 0] > 0.0:
                _add_block_into(J_a, D, J_a, row_a, row_a, K)
        if row_b >= 0:
            for j in range(6):
                for i in range(3):
                    x[row_b + j] += J_b[i, j] * (c[i] - p[i])
            if D[0, 0] > 0.0:
                _add_block_into(J_b, D, J_b, row_b, row_b, K)
        if row_a >= 0 and row_b >= 0 and D[0, 0] > 0.0:
            _add_block_into(J_a, D, J_b, row_a, row_b, K)
            _add_block_into(J_b, D, J_a, row_b, row_a, K)
    if not solve_linear_into(K, x):
        return False
    dv = np.zeros(v.shape)
    for body in range(row_of.size):
        if row_of[body] >= 0:
            dv[body] = x[row_of[body] : row_of[body] + 6]
    for contact in range(n_contacts):
        D, c = laws[contact], offsets[contact]
        d_n, d_1, d_2 = relative_velocity(contacts, contact, dv)
        p = contacts.impulse[contact]
        for i in range(3):
            p[i] = c[i] - D[i, 0] * d_n - D[i, 1] * d_1 - D[i, 2] * d_2
        p[0] = max(p[0], 0.0)
        size, limit = (
            np.sqrt(p[1] * p[1] + p[2] * p[2]),
            coefficient_along(contacts, contact, p[1], p[2]) * p[0],
        )
        if size > limit:
            p[1], p[2] = p[1] * limit / size, p[2] * limit / size
    v[:] = v_free
    for contact in range(n_contacts):
        p = contacts.impulse[contact]
        apply_impulse_into(bodies, inverse_inertia, contacts, contact, p[0], p[1], p[2], v)
    return True
