"""All contacts of a step together: Newton steps, with Gauss-Seidel sweeps where they fail."""

import numpy as np

from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import contact_velocities_into
from blockshake.solvers.nscd.solve.gauss_seidel import apply_impulses_into, relative_residual, sweep_into
from blockshake.solvers.nscd.solve.newton import newton_step_into

# Newton settles within a few steps, or wanders among states that do not fit together: the stiffer the
# proximal term the faster, the softer the surer. Tried in turn, each with its limit of steps, which are
# whole: docs/decisions/0002-nscd-newton.md.
STIFFNESS = (1e6, 1e4, 1e3, 1e2, 1e1, 1e5)
NEWTON_STEPS = (10, 15, 20, 20, 20, 20)
# Sweeps before Newton is tried again from the start; they double after each failure.
FIRST_SWEEPS = 8
# A relative residual above which an answer is not trusted, and the sweeps from no impulse that it is held against.
_TRUSTED = 1e-4
_LAST_SWEEPS = 200


@kernel_without_allocation
def _residual(contacts, v, floor, u):
    """`relative_residual` for velocities ``v`` of the bodies; ``u`` (n_contacts, 3) is worked in."""
    contact_velocities_into(contacts, v, u)
    return relative_residual(contacts, u, floor)


@kernel_without_allocation
def _size(impulse):
    """Root of the sum of the squares of all impulses [N s]."""
    squared = 0.0
    for contact in range(impulse.shape[0]):
        for axis in range(3):
            squared += impulse[contact, axis] * impulse[contact, axis]
    return np.sqrt(squared)


@inner_kernel
def _restart_into(bodies, inverse_inertia, contacts, floor, residual, v_free, v, u):
    """Sweeps from no impulse: their answer where it is nearer to the contact law, and the residual of the better one.

    Blocks that are wedged can hold any impulses against each other. A search that wanders among such impulses, and is
    stopped, has a small residual relative to them, and pushes the blocks apart with what it leaves. Sweeps from no
    impulse build up no more than the motion asks for. Both are compared by the residual itself, not relative to the
    impulses.
    """
    old_impulse, old_v = contacts.impulse.copy(), v.copy()
    old_size = residual * max(_size(old_impulse), floor)
    contacts.impulse[:] = 0.0
    copy_into(v_free, v)
    for sweep in range(_LAST_SWEEPS):
        sweep_into(bodies, inverse_inertia, contacts, sweep % 2 == 0, v)
    new = _residual(contacts, v, floor, u)
    if new * max(_size(contacts.impulse), floor) < old_size:
        return new
    copy_into(old_impulse, contacts.impulse)
    copy_into(old_v, v)
    return residual


@inner_kernel
def solve_contacts_into(
    bodies, inertia, inverse_inertia, contacts, floor, tolerance, max_iterations, v, newton
):
    """Impulses that satisfy the contact law of all contacts at once.

    Parameters
    ----------
    bodies, inertia, inverse_inertia, contacts : Bodies, float64 arrays, shape (n_bodies, 3, 3), Contacts
        Inertia in the world frame [kg m2, 1/(kg m2)]. ``contacts.impulse`` holds the start and, afterwards, the answer.
    floor, tolerance : float
        Impulse of `relative_residual` below which impulses count as that [N s]; residual that ends the search [1].
    max_iterations : int
        Newton steps and sweeps allowed, together; then an answer that is not trusted is held against sweeps.
    v : float64 array, shape (n_bodies, 6)
        Velocities at the end of the step without contact impulses; with them afterwards.
    newton : NewtonSpace
        For these contacts; worked in.

    Returns
    -------
    iterations, residual : int, float
        Newton steps and sweeps made, at least one where there are contacts; relative residual of the answer, the best
        met.

    Notes
    -----
    Newton's method on the nonsmooth equations of Alart and Curnier (1991), from the impulses of the step before. Where
    it fails with all proximal terms, sweeps of nonlinear Gauss-Seidel (NLGS) of Jean (1999), up and down in turn, start
    from the best impulses so far, and Newton tries again from where they end.
    """
    n_contacts = contacts.gap.size
    if n_contacts == 0:
        return 0, 0.0
    v_free, u = v.copy(), np.empty((n_contacts, 3))
    apply_impulses_into(bodies, inverse_inertia, contacts, v_free, v)
    best, best_impulse, best_v = _residual(contacts, v, floor, u), contacts.impulse.copy(), v.copy()
    iterations, sweeps = 0, FIRST_SWEEPS
    while True:
        for attempt in range(len(STIFFNESS)):
            for _ in range(NEWTON_STEPS[attempt]):
                if iterations == max_iterations:
                    break
                iterations += 1
                if not newton_step_into(
                    bodies, inertia, inverse_inertia, contacts, STIFFNESS[attempt], v_free, v, newton
                ):
                    break
                residual = _residual(contacts, v, floor, u)
                if residual < best:
                    best = residual
                    copy_into(contacts.impulse, best_impulse)
                    copy_into(v, best_v)
                if best <= tolerance:
                    break
            copy_into(best_impulse, contacts.impulse)
            copy_into(best_v, v)
            if best <= tolerance:
                return iterations, best
            if iterations == max_iterations:
                break
        for sweep in range(sweeps):
            if iterations == max_iterations:
                break
            iterations += 1
            sweep_into(bodies, inverse_inertia, contacts, sweep % 2 == 0, v)
        residual = _residual(contacts, v, floor, u)
        if residual < best:
            best = residual
            copy_into(contacts.impulse, best_impulse)
            copy_into(v, best_v)
        if best <= tolerance or iterations == max_iterations:
            copy_into(best_impulse, contacts.impulse)
            copy_into(best_v, v)
            if best > _TRUSTED:
                best = _restart_into(bodies, inverse_inertia, contacts, floor, best, v_free, v, u)
            return iterations, best
        sweeps *= 2
