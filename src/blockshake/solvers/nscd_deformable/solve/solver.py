"""All contacts of a step together: Newton steps, with Gauss-Seidel sweeps where they fail."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.nscd.solve.gauss_seidel import relative_residual
from blockshake.solvers.nscd.solve.solver import FIRST_SWEEPS, NEWTON_STEPS, STIFFNESS
from blockshake.solvers.nscd_deformable.solve.gauss_seidel import sweep_into
from blockshake.solvers.nscd_deformable.solve.newton import empty_laws, newton_step_into
from blockshake.solvers.nscd_deformable.solve.operator import (
    empty_operator,
    extend_into,
    own_operators_into,
    velocities_into,
)

# A kept factorisation that lowers the residual by less than this is made anew.
_SLOW = 0.1


@kernel
def solve_contacts_into(problem, contacts, floor, tolerance, max_iterations, motion, factor):
    """Impulses that satisfy the contact law of all contacts at once.

    Parameters
    ----------
    problem : Problem
    contacts : Contacts
        ``impulse`` holds the start and, afterwards, the answer.
    floor : float
        As in `relative_residual` [N s].
    tolerance : float
        Relative residual that ends the search [1].
    max_iterations : int
        Newton steps and sweeps allowed, together.
    motion : ContactMotion
        Overwritten with the velocities of the answer.
    factor : Factor
        Kept from an earlier step.

    Returns
    -------
    iterations : int
    residual : float
        Relative residual of the answer, the best met.
    factor : Factor
        To keep.
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
                    best_impulse[:] = contacts.impulse
                if best <= tolerance:
                    break
            contacts.impulse[:] = best_impulse
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
            best_impulse[:] = contacts.impulse
        if best <= tolerance or iterations == max_iterations:
            contacts.impulse[:] = best_impulse
            velocities_into(problem, contacts, motion)
            return iterations, best, factor
        sweeps *= 2
