"""Newton steps on all contacts at once, in their impulses, with a factorisation kept as long as it serves."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.vectors import matrix_product
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.nscd.solve.newton import linear_law_into
from blockshake.solvers.nscd_deformable.solve.band_elimination import factor_into, solve_into
from blockshake.solvers.nscd_deformable.solve.operator import extend_into, velocities_into

OPEN, STUCK, SLIPPING = 0, 1, 2
_SAME_PLACE = 0.01  # m; contacts that moved farther on their body have another operator


class Factor(NamedTuple):
    """A factored system, and the contacts that it belongs to.

    ``body_a``, ``body_b``, ``state`` int64 (n_contacts,) and ``home`` (n_contacts, 3): of these contacts.
    ``setting`` (2,): step [s] and stiffness of the proximal term [1]. ``matrix`` (n, n) and ``last`` int64 (n,): of
    the closed contacts' impulses, as in `factor_into`.
    """

    body_a: np.ndarray
    body_b: np.ndarray
    state: np.ndarray
    home: np.ndarray
    setting: np.ndarray
    matrix: np.ndarray
    last: np.ndarray


class Laws(NamedTuple):
    """Linear laws ``p = offset - slope u`` of the contacts, as in `linear_law_into`, and their ``state``."""

    slope: np.ndarray
    offset: np.ndarray
    state: np.ndarray


@inner_kernel
def no_factor():
    """Factor of no contacts, before the first factorisation."""
    none = np.empty(0, np.int64)
    return Factor(none, none, none, np.empty((0, 3)), np.zeros(2), np.empty((0, 0)), none)


@inner_kernel
def empty_laws(n_contacts):
    """Arrays for the laws of so many contacts."""
    return Laws(np.empty((n_contacts, 3, 3)), np.empty((n_contacts, 3)), np.empty(n_contacts, np.int64))


@kernel_without_allocation
def _laws_into(contacts, u, stiffness, laws):
    """Linear laws at the velocities ``u`` of the contacts."""
    for contact in range(contacts.gap.size):
        D = laws.slope[contact]
        linear_law_into(contacts, contact, u[contact], stiffness, D, laws.offset[contact])
        state = OPEN
        if D[0, 0] > 0.0:
            state = SLIPPING if D[1, 0] != 0.0 or D[2, 0] != 0.0 or D[1, 1] == 0.0 else STUCK
        laws.state[contact] = state


@kernel_without_allocation
def _serves(factor, contacts, laws, setting):
    """Whether a factored system still belongs to these contacts and states."""
    n = contacts.gap.size
    if factor.state.size != n or factor.setting[0] != setting[0] or factor.setting[1] != setting[1]:
        return False
    for contact in range(n):
        if (
            factor.state[contact] != laws.state[contact]
            or factor.body_a[contact] != contacts.body_a[contact]
            or factor.body_b[contact] != contacts.body_b[contact]
        ):
            return False
        for axis in range(3):
            if abs(factor.home[contact, axis] - contacts.home[contact, axis]) > _SAME_PLACE:
                return False
    return True


@kernel_without_allocation
def _system_into(laws, operator, closed, A, last):
    """The system of the contacts ``closed``, increasing, into the zeros of ``A``."""
    first, end, matrix = 0, 0, operator.matrix
    for place in range(closed.size):
        contact = closed[place]
        while operator.last[closed[first]] < contact:
            first += 1
        while end < closed.size and closed[end] <= operator.last[contact]:
            end += 1
        w0, w1, w2 = matrix[3 * contact], matrix[3 * contact + 1], matrix[3 * contact + 2]
        for i in range(3):
            row = A[3 * place + i]
            row[3 * place + i] = 1.0
            d0, d1, d2 = laws.slope[contact, i, 0], laws.slope[contact, i, 1], laws.slope[contact, i, 2]
            for other in range(first, end):
                for j in range(3):
                    at, given = 3 * other + j, 3 * closed[other] + j
                    row[at] = row[at] + d0 * w0[given] + d1 * w1[given] + d2 * w2[given]
            last[3 * place + i] = 3 * end - 1


@inner_kernel
def _factored(contacts, laws, setting, operator):
    """The system ``I + D W`` of the closed contacts, factored; its ``matrix`` is empty where it is singular."""
    closed = np.flatnonzero(laws.state != OPEN)
    A, last = np.zeros((3 * closed.size, 3 * closed.size)), np.empty(3 * closed.size, np.int64)
    _system_into(laws, operator, closed, A, last)
    if not factor_into(A, last):
        A = np.empty((0, 0))
    return Factor(
        contacts.body_a.copy(), contacts.body_b.copy(), laws.state.copy(), contacts.home.copy(), setting.copy(), A,
        last,
    )  # fmt: skip


@kernel_without_allocation
def _drop_open_into(contacts, laws):
    """Take the impulses of open contacts away; whether there were any."""
    dropped = False
    for contact in range(contacts.gap.size):
        if laws.state[contact] == OPEN:
            p = contacts.impulse[contact]
            if p[0] != 0.0 or p[1] != 0.0 or p[2] != 0.0:
                p[0] = p[1] = p[2] = 0.0
                dropped = True
    return dropped


@kernel_without_allocation
def _count_closed(laws):
    closed = 0
    for contact in range(laws.state.size):
        closed += 1 if laws.state[contact] != OPEN else 0
    return closed


@kernel_without_allocation
def _step_into(contacts, u, laws, matrix, last, x):
    """Impulses of the closed contacts after the step; ``x``, three a contact, is worked in."""
    closed = 0
    for contact in range(contacts.gap.size):
        if laws.state[contact] != OPEN:
            due = matrix_product(laws.slope[contact], u[contact])
            for axis in range(3):
                x[3 * closed + axis] = (
                    laws.offset[contact, axis] - due[axis] - contacts.impulse[contact, axis]
                )
            closed += 1
    solve_into(matrix, last, x)
    closed = 0
    for contact in range(contacts.gap.size):
        if laws.state[contact] != OPEN:
            p = contacts.impulse[contact]
            for axis in range(3):
                p[axis] += x[3 * closed + axis]
            closed += 1


@inner_kernel
def newton_step_into(problem, contacts, stiffness, fresh, operator, motion, laws, factor):
    """Replace the impulses by those of one Newton step, and the velocities with them.

    Parameters
    ----------
    problem, contacts : Problem, Contacts
        ``contacts.impulse`` is changed.
    stiffness : float
        Stiffness of the proximal term, as in `linear_law_into`.
    fresh : bool
        Factor anew even where the kept factorisation belongs to these contacts.
    operator, motion, laws : Operator, ContactMotion, Laws
        The operator of this step is extended where it is needed; motion and laws are overwritten.
    factor : Factor

    Returns
    -------
    done, made, factor : bool, bool, Factor
        Not done, with the impulses of open contacts gone at most, where the system is singular; whether the
        factorisation was made in this step.

    Notes
    -----
    ``(I + D W) dp = c - D u - p`` with the linear laws of `linear_law_into`. The velocities are those of the exact
    operator, so that an old factorisation costs iterations and no accuracy.
    """
    _laws_into(contacts, motion.u, stiffness, laws)
    if _drop_open_into(contacts, laws):
        velocities_into(problem, contacts, motion)
    setting, made = np.array([problem.response.dt, stiffness]), False
    if fresh or not _serves(factor, contacts, laws, setting):
        extend_into(problem, contacts, laws.state != OPEN, operator)
        factor, made = _factored(contacts, laws, setting, operator), True
    if factor.matrix.shape[0] != 3 * _count_closed(laws):
        return False, made, factor
    x = np.empty(factor.matrix.shape[0])
    _step_into(contacts, motion.u, laws, factor.matrix, factor.last, x)
    velocities_into(problem, contacts, motion)
    return True, made, factor
