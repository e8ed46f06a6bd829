"""Impulses that the solution of a step starts from: those of the matching contacts of the step before."""

import numpy as np

from blockshake.geometry.vectors import matrix_product, transposed_product
from blockshake.jit import kernel_without_allocation
from blockshake.solvers.nscd.contact.law import coefficient_along

# A contact takes over the impulse of the nearest one of its pair within this share of the radius.
_SAME_CONTACT = 0.1


@kernel_without_allocation
def _before(stopper, a, b, other_stopper, other_a, other_b):
    """Whether a contact comes before another in `Contacts`: pairs first, then stoppers."""
    if stopper != other_stopper:
        return stopper < other_stopper
    return a < other_a or (a == other_a and b < other_b)


@kernel_without_allocation
def _block_of_pair(contacts, a, b, stopper, start):
    """Rows ``first`` to ``last`` of a pair, or of a stopper, searched upwards from ``start``."""
    first = start
    size = contacts.gap.size
    while first < size and _before(
        contacts.stopper[first], contacts.body_a[first], contacts.body_b[first], stopper, a, b
    ):
        first += 1
    last = first
    while (
        last < size
        and contacts.stopper[last] == stopper
        and contacts.body_a[last] == a
        and contacts.body_b[last] == b
    ):
        last += 1
    return first, last


@kernel_without_allocation
def warm_start_into(old, radius, share, contacts):
    """Give each contact the impulse of the nearest one of the same pair at the step before.

    ``old`` (Contacts) are those of the step before, sorted by pair like ``contacts``, of which ``impulse``, inside
    Coulomb's cone, and ``slip_ratio`` are overwritten. ``radius`` (n_bodies,) [m]. ``share``: length of this step over
    that of the step before [1], with which the impulses of resting contacts go.
    """
    first, last = 0, 0
    for contact in range(contacts.gap.size):
        a, b, stopper = contacts.body_a[contact], contacts.body_b[contact], contacts.stopper[contact]
        limit = _SAME_CONTACT * min(radius[a], radius[b])
        nearest, match = limit * limit, -1
        first, last = _block_of_pair(old, a, b, stopper, first)
        for other in range(first, last):
            distance = 0.0
            for axis in range(3):
                d = old.home[other, axis] - contacts.home[contact, axis]
                distance += d * d
            if distance < nearest:
                nearest, match = distance, other
        contacts.impulse[contact] = 0.0
        contacts.slip_ratio[contact] = 0.0
        if match < 0:
            continue
        world = transposed_product(old.basis[match], old.impulse[match])
        p = matrix_product(contacts.basis[contact], (share * world[0], share * world[1], share * world[2]))
        limit = coefficient_along(contacts, contact, p[1], p[2]) * max(p[0], 0.0)
        size = np.sqrt(p[1] * p[1] + p[2] * p[2])
        scale = min(1.0, limit / size) if size > 0.0 else 0.0
        contacts.impulse[contact, 0] = max(p[0], 0.0)
        contacts.impulse[contact, 1] = scale * p[1]
        contacts.impulse[contact, 2] = scale * p[2]
        contacts.slip_ratio[contact] = old.slip_ratio[match]
