"""Nonlinear Gauss-Seidel sweeps over the contacts of deformable bodies."""

import numpy as np

from blockshake.jit import borrowing_kernel
from blockshake.solvers.nscd.contact.contacts import effective_mass
from blockshake.solvers.nscd.contact.friction import coefficient_along
from blockshake.solvers.nscd.solve.gauss_seidel import law_velocity
from blockshake.solvers.nscd.solve.local_solve import solve_contact


@borrowing_kernel
def sweep_into(contacts, W, upwards, u):
    """Solve every contact once in turn, first to last if ``upwards`` and back otherwise (Jean 1999).

    Parameters
    ----------
    contacts : Contacts
        ``impulse`` is changed.
    W : float64 array, shape (3 n_contacts, 3 n_contacts)
        Of `Operator`, with all contacts in it [1/kg].
    upwards : bool
    u : float64 array, shape (n_contacts, 3)
        Velocities of the contacts, kept in line with the impulses [m/s].
    """
    n = contacts.gap.size
    for rank in range(n):
        contact = rank if upwards else n - 1 - rank
        p, w = contacts.impulse[contact], W[3 * contact : 3 * contact + 3, 3 * contact : 3 * contact + 3]
        # tangents turned such that the tangential block is diagonal, as `solve_contact` asks
        angle = 0.5 * np.arctan2(2.0 * w[1, 2], w[1, 1] - w[2, 2])
        c, s = np.cos(angle), np.sin(angle)
        share = contacts.share[contact]
        w_n = share * w[0, 0] + contacts.compliance[contact]
        w_1 = c * c * w[1, 1] + 2.0 * c * s * w[1, 2] + s * s * w[2, 2]
        w_2 = s * s * w[1, 1] - 2.0 * c * s * w[1, 2] + c * c * w[2, 2]
        a_1, a_2 = c * w[0, 1] + s * w[0, 2], c * w[0, 2] - s * w[0, 1]
        u_n, u_x, u_y = law_velocity(contacts, contact, u[contact])
        rho = effective_mass(contacts.delassus[contact])
        mu = coefficient_along(contacts, contact, p[1] - rho * u_x, p[2] - rho * u_y)
        p_1, p_2 = c * p[1] + s * p[2], c * p[2] - s * p[1]
        q_n = u_n - w_n * p[0] - a_1 * p_1 - a_2 * p_2
        q_1 = c * u_x + s * u_y - a_1 * p[0] - w_1 * p_1
        q_2 = c * u_y - s * u_x - a_2 * p[0] - w_2 * p_2
        new_n, new_1, new_2, slip = solve_contact(
            w_n, w_1, w_2, a_1, a_2, q_n, q_1, q_2, mu, contacts.slip_ratio[contact]
        )
        contacts.slip_ratio[contact] = slip
        d = (new_n - p[0], c * new_1 - s * new_2 - p[1], s * new_1 + c * new_2 - p[2])
        if d[0] == 0.0 and d[1] == 0.0 and d[2] == 0.0:
            continue
        for axis in range(3):
            p[axis] += d[axis]
            row = W[3 * contact + axis]
            for other in range(n):
                u[other, 0] += row[3 * other] * d[axis]
                u[other, 1] += row[3 * other + 1] * d[axis]
                u[other, 2] += row[3 * other + 2] * d[axis]
