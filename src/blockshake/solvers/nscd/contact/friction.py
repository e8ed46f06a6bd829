"""Coulomb's coefficient of each contact: by pair, slip rate, slip and joint, and by the direction of slip."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.friction import (
    FrictionLaws,
    assemble_friction,
    friction_asymmetry,
    friction_coefficient,
)
from blockshake.jit import borrowing_kernel
from blockshake.solvers.vectors import dot


class OrderedFriction(NamedTuple):
    """``laws`` (FrictionLaws), bodies in the solver's order; ``file_index`` int64 (n_bodies,): theirs in the file."""

    laws: FrictionLaws
    file_index: np.ndarray


def ordered_friction(structure, order):
    """Friction of a structure whose bodies are handled in the order of the indices ``order``."""
    laws = assemble_friction(structure)
    place = np.argsort(order)
    ordered = laws._replace(
        material=np.ascontiguousarray(laws.material[order]),
        joint=np.ascontiguousarray(np.sort(place[laws.joint], axis=1)),
    )
    return OrderedFriction(ordered, np.ascontiguousarray(order))


@borrowing_kernel
def friction_into(friction, joints, rotations, contacts):
    """Fill in the coefficients of the contacts and their bias by direction.

    Parameters
    ----------
    friction : OrderedFriction
    joints : Joints
        Slip rate and slip at the start of the step: the coefficient follows them a step behind.
    rotations : float64 array, shape (n_bodies, 3, 3)
        Body to world.
    contacts : Contacts
        ``friction`` and ``bias`` are overwritten but for the stoppers'; the tangents are given.

    Notes
    -----
    A positive asymmetry raises the coefficient for slip of the joint's second body, by the file's order, along
    the x axis of its first; ``bias`` says so of b against a, whichever of them is lower.
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


@borrowing_kernel
def coefficient_along(contacts, contact, p_1, p_2):
    """Coefficient of a contact whose friction pushes b along (p_1, p_2), so that it slips the other way [1]."""
    mu = contacts.friction[contact]
    bias_1, bias_2 = contacts.bias[contact, 0], contacts.bias[contact, 1]
    size = np.sqrt(p_1 * p_1 + p_2 * p_2)
    return mu - (bias_1 * p_1 + bias_2 * p_2) / size if size > 0.0 else mu
