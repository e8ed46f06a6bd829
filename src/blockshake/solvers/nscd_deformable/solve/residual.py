"""Residual of the contact law for given velocities of the contacts."""

import numpy as np

from blockshake.jit import borrowing_kernel
from blockshake.solvers.nscd.contact.contacts import effective_mass
from blockshake.solvers.nscd.contact.friction import coefficient_along
from blockshake.solvers.nscd.solve.local_solve import contact_residual


@borrowing_kernel
def law_velocity(contacts, contact, u):
    """Velocity that the law is written in: a contact's ``u`` (3,) and its shifts, compliance in the normal [m/s]."""
    shift = contacts.shift[contact]
    u_n = (
        contacts.share[contact] * (u[0] + shift[0])
        + contacts.compliance[contact] * contacts.impulse[contact, 0]
    )
    return u_n, u[1] + shift[1], u[2] + shift[2]


@borrowing_kernel
def residual_of(contacts, u, floor):
    """Root of the summed squares of `contact_residual` over that of the impulses, or over ``floor`` [N s].

    ``u`` (n_contacts, 3): velocities of the contacts, along their bases [m/s].
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
