"""State of an NSCD run and of its joints between two steps: enough to stop it there and to go on from there."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import ENERGY_TERMS, State
from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel, kernel_without_allocation

# Entries of ``clock`` after `STEP` and `NEXT_RECORD` of `blockshake.solvers.record`: sums and counts over the steps
ITERATIONS, MOST_ITERATIONS, BAD_STEPS, CAPPED_STEPS, PARTED_STEPS, N_CLOCK = 2, 3, 4, 5, 6, 7
# Entries of ``audit``: net work taken out so far by friction and by normal impulses, largest misfit of the
# energy terms and largest energy in play [J], largest relative residual [1], deepest penetration [m], length of
# the last step or part of a step [s], energy in soft layers and stops [J]
FRICTION_WORK, NORMAL_WORK, MISFIT, IN_PLAY, WORST_RESIDUAL, DEEPEST, LAST_STEP, HELD, N_AUDIT = range(9)


class Progress(NamedTuple):
    """State of a run between two steps, changed in place by kernels.

    ``state``: at the last step. ``energy``, ``energy_start`` (7,): `ENERGY_TERMS` at the last step and
    at the first [J]. ``face`` int64 (n_bodies, n_bodies): of each pair, as in `detect_pair_into`.
    ``clock`` int64 (N_CLOCK,). ``audit`` (N_AUDIT,).
    """

    state: State
    energy: np.ndarray
    energy_start: np.ndarray
    face: np.ndarray
    clock: np.ndarray
    audit: np.ndarray


def start_progress(state):
    """Progress before the first step."""
    n_bodies = len(state.position)
    return Progress(
        state=state,
        energy=np.zeros(len(ENERGY_TERMS)),
        energy_start=np.zeros(len(ENERGY_TERMS)),
        face=np.full((n_bodies, n_bodies), -1, np.int64),
        clock=np.zeros(N_CLOCK, np.int64),
        audit=np.zeros(N_AUDIT),
    )


class Joints(NamedTuple):
    """Joints in the order in which their bodies first pressed on each other.

    ``row`` int64 (n_bodies, n_bodies): joint of a pair, the lower index first, -1 for none. ``pair`` int64
    (n_joints, 2). ``slip`` (n_joints,): made so far, either way [m]; ``slip_rate`` (n_joints,): at the last step [m/s].
    ``sums`` (n_joints, 2): workspace.
    """

    row: np.ndarray
    pair: np.ndarray
    slip: np.ndarray
    slip_rate: np.ndarray
    sums: np.ndarray


def no_joints(n_bodies):
    """Joints before any body touched another."""
    return Joints(
        np.full((n_bodies, n_bodies), -1, np.int64),
        np.empty((0, 2), np.int64),
        np.empty(0),
        np.empty(0),
        np.empty((0, 2)),
    )


@kernel_without_allocation
def press_anew(joints, contacts, n_contacts):
    """Whether two bodies without a joint press on each other; the first ``n_contacts`` contacts are those of bodies."""
    for contact in range(n_contacts):
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        if joints.row[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
            return True
    return False


@inner_kernel
def with_pressed(joints, contacts, n_contacts):
    """Joints, followed by those of bodies that press on each other for the first time, which have not slipped yet.

    The first ``n_contacts`` of the contacts are of bodies. ``row`` is changed in place.
    """
    for contact in range(n_contacts):
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        if joints.row[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
            joints = _with_joint(joints, a, b)
    return joints


@inner_kernel
def _with_joint(joints, a, b):
    """Joints with one more, which has not slipped yet; ``row`` is changed in place."""
    n = joints.slip.size
    new = Joints(
        joints.row, np.empty((n + 1, 2), np.int64), np.zeros(n + 1), np.zeros(n + 1), np.zeros((n + 1, 2))
    )
    copy_into(joints.pair, new.pair)
    copy_into(joints.slip, new.slip)
    copy_into(joints.slip_rate, new.slip_rate)
    new.row[a, b] = n
    new.pair[n, 0], new.pair[n, 1] = a, b
    return new


@kernel_without_allocation
def slip_into(contacts, n_contacts, u, dt, theta, joints):
    """Bring slip and slip rate of the joints up to the end of a step.

    ``u`` (n_contacts, 3): velocities of the contacts at the end of the step, along their bases [m/s]; the first
    ``n_contacts`` contacts are of bodies, not of stoppers. ``dt`` [s], ``theta`` [1].

    Notes
    -----
    The slip rate is the mean of the contacts' sliding speeds, weighted by their normal impulses; the slip gains
    the mean of the rates at both ends of the step by the rule of the positions. A contact that sticks has
    neither, to the tolerance of the solver.
    """
    sums = joints.sums
    sums[:] = 0.0
    for contact in range(n_contacts):
        joint = joints.row[contacts.body_a[contact], contacts.body_b[contact]]
        p_n = contacts.impulse[contact, 0]
        if joint >= 0 and p_n > 0.0:
            u_1, u_2 = u[contact, 1] + contacts.shift[contact, 1], u[contact, 2] + contacts.shift[contact, 2]
            sums[joint, 0] += p_n * np.sqrt(u_1 * u_1 + u_2 * u_2)
            sums[joint, 1] += p_n
    for joint in range(joints.slip.size):
        now = sums[joint, 0] / sums[joint, 1] if sums[joint, 1] > 0.0 else 0.0
        joints.slip[joint] += dt * ((1.0 - theta) * joints.slip_rate[joint] + theta * now)
        joints.slip_rate[joint] = now
