"""All contacts of a step together: Newton steps, with Gauss-Seidel sweeps where they fail."""

import numpy as np

from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import effective_mass
from blockshake.solvers.nscd.contact.law import coefficient_along, law_velocity
from blockshake.solvers.nscd.solve.gauss_seidel import relative_residual, solve_contact
from blockshake.solvers.nscd.solve.solver import FIRST_SWEEPS, NEWTON_STEPS, STIFFNESS
from blockshake.solvers.nscd_deformable.solve.newton import empty_laws, newton_step_into
from blockshake.solvers.nscd_deformable.solve.operator import (
    empty_operator,
    extend_into,
    own_operators_into,
    velocities_into,
)

# A kept factorisation that lowers the residual by less than this is made anew.
_SLOW = 0.1


@kernel_without_allocation
def sweep_into(contacts, W, upwards, u):
    """Solve every contact once in turn, first to last if ``upwards`` and back otherwise (Jean 1999).

    ``contacts.impulse`` is changed, and ``u`` (n_contacts, 3), the velocities of the contacts [m/s], is kept in line
    with it. ``W`` (3 n_contacts, 3 n_contacts): matrix of an `Operator` with all contacts in it [1/kg].
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


@inner_kernel
def solve_contacts_into(problem, contacts, floor, tolerance, max_iterations, motion, factor):
    """Impulses that satisfy the contact law of all contacts at once.

    Parameters
    ----------
    problem, contacts : Problem, Contacts
        ``contacts.impulse`` holds the start and, afterwards, the answer.
    floor, tolerance, max_iterations : float, float, int
        As in `blockshake.solvers.nscd.solve.solver.solve_contacts_into` [N s, 1, 1].
    motion : ContactMotion
        Overwritten with the velocities of the answer.
    factor : Factor
        Kept from an earlier step.

    Returns
    -------
    iterations, residual, factor : int, float, Factor
        Newton steps and sweeps made; the best relative residual met, that of the answer; factorisation to keep.
    """
    n = contacts.gap.size
    own_operators_into(problem, contacts)
    velocities_into(problem, contacts, motion)
    if n == 0:
        return 0, 0.0, factor
    best, best_impulse = relative_residual(contacts, motion.u, floor), contacts.impulse.copy()
    operator, laws = empty_operator(problem, contacts), empty_laws(n)
    iterations, sweeps = 0, FIRST_SWEEPS
    while True:
        for attempt in range(len(STIFFNESS)):
            fresh = False
            for _ in range(NEWTON_STEPS[attempt]):
                if iterations == max_iterations:
                    break
                iterations += 1
                before = relative_residual(contacts, motion.u, floor)
                done, made, factor = newton_step_into(
                    problem, contacts, STIFFNESS[attempt], fresh, operator, motion, laws, factor
                )
                if not done:
                    break
                residual = relative_residual(contacts, motion.u, floor)
                fresh = not made and residual > _SLOW * before
                if residual < best:
                    best = residual
                    copy_into(contacts.impulse, best_impulse)
                if best <= tolerance:
                    break
            copy_into(best_impulse, contacts.impulse)
            velocities_into(problem, contacts, motion)
            if best <= tolerance or iterations == max_iterations:
                return iterations, best, factor
        extend_into(problem, contacts, np.ones(n, np.bool_), operator)
        for sweep in range(sweeps):
            if iterations == max_iterations:
                break
            iterations += 1
            sweep_into(contacts, operator.matrix, sweep % 2 == 0, motion.u)
        velocities_into(problem, contacts, motion)
        residual = relative_residual(contacts, motion.u, floor)
        if residual < best:
            best = residual
            copy_into(contacts.impulse, best_impulse)
        if best <= tolerance or iterations == max_iterations:
            copy_into(best_impulse, contacts.impulse)
            velocities_into(problem, contacts, motion)
            return iterations, best, factor
        sweeps *= 2
