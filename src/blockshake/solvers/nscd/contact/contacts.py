"""The contacts of one step, of bodies and of stoppers: where they are, their operators, and what they remember."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.overlap import find_pairs
from blockshake.geometry.vectors import cross, difference, dot, matrix_product, put_into, transposed_product
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.external_forces import closure_into
from blockshake.solvers.nscd.contact.detection import detect_pair_into

# Contacts are looked for at least this far apart, since a body at rest may be pushed within a step [m].
_LEAST_MARGIN = 1e-4
# Entries of ``Contacts.delassus``: a symmetric 3 x 3 matrix whose entry of the two tangents is zero
W_NN, W_11, W_22, W_N1, W_N2, N_DELASSUS = 0, 1, 2, 3, 4, 5


class Contacts(NamedTuple):
    """Contacts of one step, pair by pair in fixed order, stoppers last.

    ``body_a``, ``body_b`` int64 (n,): impulses act on b and, reversed, on a. ``basis`` (n, 3, 3): rows are the unit
    normal from a to b and two tangents, world frame. ``arm_a``, ``arm_b`` (n, 3): point minus mass centre, world frame
    [m]. ``home`` (n, 3): point in the frame of a [m]. ``gap`` (n,) [m]; ``friction`` (n,) [1] and ``bias`` (n, 2) [1]:
    the coefficient is ``friction + bias . s`` for slip of b along the unit vector s of the tangents. ``shift`` (n, 3):
    velocity added to that of the contact before the law is applied [m/s]. ``share`` (n,) [1] and ``compliance`` (n,)
    [1/kg] of the normal law ``share (u_n + bound_n) + compliance p_n >= 0``: 1 and 0 where rigid bodies touch, a
    compliance where a layer is between them; only a contact without friction may have another share. ``delassus``
    (n, N_DELASSUS): operator of the local problem, see `delassus_into` [1/kg]. ``impulse`` (n, 3) along the basis
    [N s]. ``slip_ratio`` (n,): slip speed per friction impulse, of `solve_contact` [1/kg]. ``stopper`` int64 (n,):
    index of the stopper, or -1.
    """

    body_a: np.ndarray
    body_b: np.ndarray
    basis: np.ndarray
    arm_a: np.ndarray
    arm_b: np.ndarray
    home: np.ndarray
    gap: np.ndarray
    friction: np.ndarray
    bias: np.ndarray
    shift: np.ndarray
    share: np.ndarray
    compliance: np.ndarray
    delassus: np.ndarray
    impulse: np.ndarray
    slip_ratio: np.ndarray
    stopper: np.ndarray


@inner_kernel
def empty_contacts(capacity):
    """Arrays for that many contacts."""
    return Contacts(
        np.empty(capacity, np.int64), np.empty(capacity, np.int64), np.empty((capacity, 3, 3)),
        np.empty((capacity, 3)), np.empty((capacity, 3)), np.empty((capacity, 3)), np.empty(capacity),
        np.zeros(capacity), np.zeros((capacity, 2)), np.zeros((capacity, 3)), np.ones(capacity), np.zeros(capacity),
        np.empty((capacity, N_DELASSUS)), np.zeros((capacity, 3)), np.zeros(capacity),
        np.full(capacity, -1, np.int64),
    )  # fmt: skip


@inner_kernel
def first_rows(contacts, count):
    """The first so many contacts, as views."""
    return Contacts(
        contacts.body_a[:count], contacts.body_b[:count], contacts.basis[:count], contacts.arm_a[:count],
        contacts.arm_b[:count], contacts.home[:count], contacts.gap[:count], contacts.friction[:count],
        contacts.bias[:count], contacts.shift[:count], contacts.share[:count], contacts.compliance[:count],
        contacts.delassus[:count], contacts.impulse[:count], contacts.slip_ratio[:count], contacts.stopper[:count],
    )  # fmt: skip


@kernel_without_allocation
def contact_margin(v_start, radius, gravity, dt):
    """Gap up to which points of two bodies are kept as contacts: what no pair can close in a step [m]."""
    fastest = 0.0
    for body in range(radius.size):
        v = v_start[body]
        fastest = max(fastest, np.sqrt(dot(v[:3], v[:3])) + radius[body] * np.sqrt(dot(v[3:], v[3:])))
    return _LEAST_MARGIN + 2.0 * dt * (fastest + dt * np.sqrt(dot(gravity, gravity)))


@kernel_without_allocation
def add_contact_into(contacts, count, a, b, placed, rotations, normal, point, gap, compliance):
    """Write a contact of the bodies a and b at a point, (3,) in the world frame [m], into row ``count``.

    ``normal`` (3,): from a to b; ``gap`` [m] and ``compliance`` [1/kg] as in `Contacts`.
    """
    contacts.body_a[count], contacts.body_b[count] = a, b
    contacts.gap[count], contacts.compliance[count] = gap, compliance
    put_into(normal, contacts.basis[count, 0])
    put_into(difference(point, placed.center[a]), contacts.arm_a[count])
    put_into(difference(point, placed.center[b]), contacts.arm_b[count])
    put_into(transposed_product(rotations[a], contacts.arm_a[count]), contacts.home[count])


@kernel_without_allocation
def _detect_into(
    pairs, polyhedra, placed, rotations, margin, shrink, layers, admittance, memory, normal, points, gaps, areas,
    contacts,
):  # fmt: skip
    """Contacts of the pairs, as in `detect_contacts`; their number. The arrays are as in `detect_pair_into`."""
    count = 0
    for pair in range(pairs.shape[0]):
        a, b = pairs[pair, 0], pairs[pair, 1]
        layer = layers[a, b]
        n_points = detect_pair_into(
            polyhedra, placed, a, b, margin, shrink, layer, memory, normal, points, gaps, areas
        )
        if n_points == 0:
            memory[a, b] = -1
        for point in range(n_points):
            compliance = layer / (admittance * areas[point])
            add_contact_into(
                contacts, count, a, b, placed, rotations, normal, points[point], gaps[point], compliance
            )
            count += 1
    return count


@inner_kernel
def detect_contacts(
    bodies, polyhedra, placed, rotations, margin, shrink, layers, admittance, memory, n_stoppers
):
    """Contacts of all pairs of polyhedra: geometry, gap and compliance; rows of the stoppers come last, still empty.

    Parameters
    ----------
    bodies, polyhedra, placed : Bodies, Polyhedra, Placed
    rotations : float64 array, shape (n_bodies, 3, 3)
        Body to world.
    margin, shrink, memory
        As in `detect_pair_into`.
    layers : float64 array, shape (n_bodies, n_bodies)
        Compliance of the layers in the joints [m3/N].
    admittance : float
        Impulse over stiffness and velocity, ``theta h^2``, of an implicit spring [s2].
    n_stoppers : int
    """
    pairs = find_pairs(placed.low, placed.high, bodies.driven, margin)
    contacts = empty_contacts(5 * pairs.shape[0] + n_stoppers)
    count = _detect_into(
        pairs, polyhedra, placed, rotations, margin, shrink, layers, admittance, memory, np.empty(3),
        np.empty((5, 3)), np.empty(5), np.empty(5), contacts,
    )  # fmt: skip
    return first_rows(contacts, count + n_stoppers)


@kernel_without_allocation
def _with_body(W, arm, inverse_mass, inverse_inertia, basis):
    """``W`` and one body's share of ``basis (1/m - arm x I^-1 arm x) basis^T``; the upper entries, row by row."""
    along, first, second = cross(arm, basis[0]), cross(arm, basis[1]), cross(arm, basis[2])
    spin, turn = matrix_product(inverse_inertia, along), matrix_product(inverse_inertia, first)
    return (
        W[0] + inverse_mass + dot(along, spin),
        W[1] + dot(first, spin),
        W[2] + dot(second, spin),
        W[3] + inverse_mass + dot(first, turn),
        W[4] + dot(second, turn),
        W[5] + inverse_mass + dot(second, matrix_product(inverse_inertia, second)),
    )


@kernel_without_allocation
def _tangents_into(basis):
    """Two tangents that complete a right-handed frame with the normal ``basis[0]``."""
    n = basis[0]
    least = 0
    for axis in range(1, 3):
        if abs(n[axis]) < abs(n[least]):
            least = axis
    t = cross(n, (1.0 * (least == 0), 1.0 * (least == 1), 1.0 * (least == 2)))
    size = np.sqrt(dot(t, t))
    put_into((t[0] / size, t[1] / size, t[2] / size), basis[1])
    put_into(cross(n, basis[1]), basis[2])


@kernel_without_allocation
def delassus_into(bodies, inverse_inertia, contacts):
    """Fill in the tangents and the Delassus operators, ``W = J M^-1 J^T`` of each contact alone.

    The velocity of a contact along its basis is ``u = W p + q``, q being that without its own impulse p. The bases need
    their normals; the tangents are turned such that the tangential block of the operator is diagonal. A contact's share
    and compliance are in its `W_NN`. ``inverse_inertia`` (n_bodies, 3, 3): world frame, zero for driven bodies
    [1/(kg m2)].
    """
    for contact in range(contacts.gap.size):
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        basis = contacts.basis[contact]
        _tangents_into(basis)
        W = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        W = _with_body(W, contacts.arm_a[contact], bodies.inverse_mass[a], inverse_inertia[a], basis)
        W = _with_body(W, contacts.arm_b[contact], bodies.inverse_mass[b], inverse_inertia[b], basis)
        w_nn, w_n1, w_n2, w_11, w_12, w_22 = W
        angle = 0.5 * np.arctan2(2.0 * w_12, w_11 - w_22)
        c, s = np.cos(angle), np.sin(angle)
        for axis in range(3):
            t_1, t_2 = basis[1, axis], basis[2, axis]
            basis[1, axis], basis[2, axis] = c * t_1 + s * t_2, c * t_2 - s * t_1
        w = contacts.delassus[contact]
        w[W_NN] = contacts.share[contact] * w_nn + contacts.compliance[contact]
        w[W_11] = c * c * w_11 + 2.0 * c * s * w_12 + s * s * w_22
        w[W_22] = s * s * w_11 - 2.0 * c * s * w_12 + c * c * w_22
        w[W_N1] = c * w_n1 + s * w_n2
        w[W_N2] = c * w_n2 - s * w_n1


@kernel_without_allocation
def effective_mass(w):
    """Least mass that a contact with the Delassus operator ``w`` moves along its basis [kg]."""
    return 1.0 / max(w[W_NN], max(w[W_11], w[W_22]))


@inner_kernel
def place_stoppers_into(bodies, stoppers, base, step, dt, theta, contacts):
    """Write the stoppers, if any, as contacts of the driven body ``base`` into the last rows.

    The law of an implicit spring that only pushes, ``u_n + shift + p / s >= 0`` with ``s = theta dt^2 k``, times ``s
    / (s + m)``, m the mass of the body: so a stop without stiffness has the law ``p / m >= 0``, and no impulse.
    """
    if stoppers is None:
        return
    first = contacts.gap.size - stoppers.body.size
    toward = np.empty(3)
    for stopper in range(stoppers.body.size):
        row, body = first + stopper, stoppers.body[stopper]
        contacts.body_a[row], contacts.body_b[row] = base, body
        contacts.stopper[row] = stopper
        put_into(stoppers.point[stopper], contacts.home[row])
        contacts.friction[row] = 0.0
        admittance = theta * dt * dt * stoppers.stiffness[stopper]
        contacts.share[row] = admittance / (admittance + bodies.mass[body])
        contacts.compliance[row] = 1.0 / (admittance + bodies.mass[body])
        closed = closure_into(
            bodies, stoppers, stopper, base, step.detection, contacts.arm_a[row], contacts.arm_b[row], toward
        )
        contacts.gap[row] = -closed
        put_into((-toward[0], -toward[1], -toward[2]), contacts.basis[row, 0])


@kernel_without_allocation
def relative_velocity(contacts, contact, v):
    """Velocity of b minus that of a at a contact, along its basis [m/s].

    ``v`` (n_bodies, 6): velocity [m/s] and angular velocity [rad/s] of the bodies, world frame.
    """
    a, b = v[contacts.body_a[contact]], v[contacts.body_b[contact]]
    r, s = contacts.arm_a[contact], contacts.arm_b[contact]
    x = b[0] + b[4] * s[2] - b[5] * s[1] - a[0] - a[4] * r[2] + a[5] * r[1]
    y = b[1] + b[5] * s[0] - b[3] * s[2] - a[1] - a[5] * r[0] + a[3] * r[2]
    z = b[2] + b[3] * s[1] - b[4] * s[0] - a[2] - a[3] * r[1] + a[4] * r[0]
    return matrix_product(contacts.basis[contact], (x, y, z))


@kernel_without_allocation
def contact_velocities_into(contacts, v, u):
    """Velocities of all contacts along their bases [m/s], into ``u`` (n_contacts, 3); ``v`` as there."""
    for contact in range(contacts.gap.size):
        u[contact, 0], u[contact, 1], u[contact, 2] = relative_velocity(contacts, contact, v)
