"""Pairs of bodies that have touched, and the slip that their friction remembers."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import borrowing_kernel, kernel


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


@borrowing_kernel
def press_anew(joints, contacts, n_contacts):
    """Whether a pair without a joint presses on each other; the first ``n_contacts`` of the contacts are of bodies."""
    for contact in range(n_contacts):
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        if joints.row[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
            return True
    return False


@kernel
def with_pressed(joints, contacts, n_contacts):
    """Joints, and after them those of pairs that press on each other for the first time; they have not slipped yet.

    The first ``n_contacts`` of the contacts are of bodies. ``row`` is changed in place.
    """
    for contact in range(n_contacts):
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        if joints.row[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
            joints = _with_joint(joints, a, b)
    return joints


@kernel
def _with_joint(joints, a, b):
    """Joints with one more, which has not slipped yet; ``row`` is changed in place."""
    n = joints.slip.size
    new = Joints(
        joints.row, np.empty((n + 1, 2), np.int64), np.zeros(n + 1), np.zeros(n + 1), np.zeros((n + 1, 2))
    )
    new.pair[:n], new.slip[:n], new.slip_rate[:n] = joints.pair, joints.slip, joints.slip_rate
    new.row[a, b] = n
    new.pair[n, 0], new.pair[n, 1] = a, b
    return new


@borrowing_kernel
def slip_into(contacts, n_contacts, u, dt, theta, joints):
    """Bring slip and slip rate of the joints up to the end of a step.

    Parameters
    ----------
    contacts : Contacts
        With the impulses of the step; the first ``n_contacts`` are of bodies, not of stoppers.
    u : float64 array, shape (n_contacts, 3)
        Velocities of the contacts at the end of the step, along their bases [m/s].
    dt, theta : float
        [s], [1]
    joints : Joints
        Changed in place.

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
