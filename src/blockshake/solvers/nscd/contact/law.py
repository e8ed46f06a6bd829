"""The contact law of a step: Coulomb's coefficient of each contact, and the velocities added to that of the contact."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.friction import (
    FrictionLaws,
    assemble_friction,
    friction_asymmetry,
    friction_coefficient,
)
from blockshake.geometry.vectors import dot
from blockshake.jit import kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import relative_velocity


class OrderedFriction(NamedTuple):
    """``laws`` (FrictionLaws), bodies in the solver's order; ``file_index`` int64 (n_bodies,): theirs in the file."""

    laws: FrictionLaws
    file_index: np.ndarray


def ordered_friction(structure, order):
    """Friction of a structure whose bodies are handled in the order of the indices ``order``."""
    laws = assemble_friction(structure)
    rank = np.argsort(order)
    ordered = laws._replace(
        material=np.ascontiguousarray(laws.material[order]),
        joint=np.ascontiguousarray(np.sort(rank[laws.joint], axis=1)),
    )
    return OrderedFriction(ordered, np.ascontiguousarray(order))


@kernel_without_allocation
def friction_into(friction, joints, rotations, contacts):
    """Fill in the coefficients of the contacts and their bias by direction, but for those of the stoppers.

    Parameters
    ----------
    friction, joints, contacts : OrderedFriction, Joints, Contacts
        The coefficient follows slip rate and slip of the joints a step behind. The tangents of the contacts are given.
    rotations : float64 array, shape (n_bodies, 3, 3)
        Body to world.

    Notes
    -----
    A positive asymmetry raises the coefficient for slip of the joint's second body, by the file's order, along
    the x axis of its first; ``bias`` states it of b against a, whichever of them is lower.
    """
    laws = friction.laws
    a, b = -1, -1
    mu, toward = 0.0, (0.0, 0.0, 0.0)
    for contact in range(contacts.gap.size):
        if contacts.stopper[contact] >= 0:
            continue
        if contacts.body_a[contact] != a or contacts.body_b[contact] != b:
            a, b = contacts.body_a[contact], contacts.body_b[contact]
            joint = joints.row[a, b]
            rate, slip = (joints.slip_rate[joint], joints.slip[joint]) if joint >= 0 else (0.0, 0.0)
            mu = friction_coefficient(laws, a, b, rate, slip)
            share = mu * friction_asymmetry(laws, a, b)
            a_is_first = friction.file_index[a] < friction.file_index[b]
            R, share = (rotations[a], share) if a_is_first else (rotations[b], -share)
            toward = share * R[0, 0], share * R[1, 0], share * R[2, 0]
        contacts.friction[contact] = mu
        for tangent in range(2):
            contacts.bias[contact, tangent] = dot(contacts.basis[contact, 1 + tangent], toward)


@kernel_without_allocation
def coefficient_along(contacts, contact, p_1, p_2):
    """Coefficient of a contact whose friction pushes b along (p_1, p_2), so that it slips the other way [1]."""
    mu = contacts.friction[contact]
    bias_1, bias_2 = contacts.bias[contact, 0], contacts.bias[contact, 1]
    size = np.sqrt(p_1 * p_1 + p_2 * p_2)
    return mu - (bias_1 * p_1 + bias_2 * p_2) / size if size > 0.0 else mu


@kernel_without_allocation
def law_shift_into(step, dt, theta, restitution, contacts):
    """Fill in ``shift``, the velocities that the contact law adds to those of the contacts.

    Notes
    -----
    Poses of detection are ``dt`` apart, and the velocity at the end of a step carries one to the next: ``gap + dt u_n``
    is the next gap. So ``u_n + max(gap, 0) / dt >= 0`` lets a contact close and no more, and leaves a penetration as it
    is. ``u`` must be measured with the levers halfway between these two poses; those at hand are ``dt / 2`` older, and
    the difference is the centripetal velocity added here. Newton's restitution replaces the anticipated gap where the
    velocity at the start would close the gap within the step. The law of a stop and of a layer is implicit: impulse
    ``dt k`` times the closure at the end. All points of a layer press at once, and what the levers add along it is that
    of its deepest point for all of them: else those that stick would be stretched apart, and hold the block.
    """
    a, b, deepest = -1, -1, 0
    for contact in range(contacts.gap.size):
        basis, shift = contacts.basis[contact], contacts.shift[contact]
        gap = contacts.gap[contact]
        if contacts.body_a[contact] != a or contacts.body_b[contact] != b:
            a, b = contacts.body_a[contact], contacts.body_b[contact]
            deepest = _deepest_of_pair(contacts, contact)
        layered = contacts.compliance[contact] > 0.0 and contacts.stopper[contact] < 0
        turn = _turn_of_levers(step, contacts, contact)
        along = _turn_of_levers(step, contacts, deepest if layered else contact)
        shift[0] = 0.5 * dt * dot(basis[0], turn)
        shift[1], shift[2] = 0.5 * dt * dot(basis[1], along), 0.5 * dt * dot(basis[2], along)
        if contacts.compliance[contact] > 0.0:
            shift[0] += gap / (theta * dt)
            continue
        closing, _, _ = relative_velocity(contacts, contact, step.v_start)
        if restitution > 0.0 and closing < 0.0 and gap + dt * closing <= 0.0:
            shift[0] += restitution * closing
        else:
            shift[0] += max(gap, 0.0) / dt


@kernel_without_allocation
def _deepest_of_pair(contacts, first):
    """The contact with the least gap among those of the pair of bodies that begin at ``first``."""
    deepest, contact = first, first
    while (
        contact < contacts.gap.size
        and contacts.body_a[contact] == contacts.body_a[first]
        and contacts.body_b[contact] == contacts.body_b[first]
    ):
        if contacts.gap[contact] < contacts.gap[deepest]:
            deepest = contact
        contact += 1
    return deepest


@kernel_without_allocation
def _turn_of_levers(step, contacts, contact):
    """Centripetal acceleration of b's point less that of a's [m/s2]."""
    of_b = _centripetal(step.v_start[contacts.body_b[contact], 3:], contacts.arm_b[contact])
    of_a = _centripetal(step.v_start[contacts.body_a[contact], 3:], contacts.arm_a[contact])
    return of_b[0] - of_a[0], of_b[1] - of_a[1], of_b[2] - of_a[2]


@kernel_without_allocation
def bodies_meet(contacts, n_contacts, v_start, speed):
    """Whether a contact of bodies presses that closed faster than ``speed`` [m/s] when the step began."""
    for contact in range(n_contacts):
        if contacts.impulse[contact, 0] > 0.0:
            closing, _, _ = relative_velocity(contacts, contact, v_start)
            if closing < -speed:
                return True
    return False


@kernel_without_allocation
def _centripetal(spin, arm):
    """``spin x (spin x arm)`` [m/s2]."""
    along, squared = dot(spin, arm), dot(spin, spin)
    return (
        along * spin[0] - squared * arm[0],
        along * spin[1] - squared * arm[1],
        along * spin[2] - squared * arm[2],
    )


@kernel_without_allocation
def law_velocity(contacts, contact, u):
    """Velocity that the law is written in: a contact's ``u`` and its shifts, compliance in the normal [m/s]."""
    shift = contacts.shift[contact]
    u_n = (
        contacts.share[contact] * (u[0] + shift[0])
        + contacts.compliance[contact] * contacts.impulse[contact, 0]
    )
    return u_n, u[1] + shift[1], u[2] + shift[2]
