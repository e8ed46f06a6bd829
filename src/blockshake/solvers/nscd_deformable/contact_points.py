"""Contact points of deformable bodies: a lattice over each joint, with the lattice points of both faces around each."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.overlap import find_pairs
from blockshake.geometry.vectors import copy_into, cross, difference, dot, put_into, transposed_product
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.nscd.contact.contacts import add_contact_into, empty_contacts, first_rows
from blockshake.solvers.nscd.contact.detection import LEAST_AREA, detect_pair_into
from blockshake.solvers.nscd_deformable.elastic_bodies import anchor_into

# Corners of a joint are looked for this many margins apart, to find points between an open and a closed corner.
_WIDE = 10.0
_SAME_POINT = 1e-6  # m


class Anchors(NamedTuple):
    """Where the contacts of a step hold on to the deformable bodies.

    ``active`` int64 (n_active,) and ``first`` int64 (n_bodies + 1,): lattice points of any contact, body by body,
    increasing, and where those of each begin. ``points`` int64 (n_contacts, 2, 4), ``weights`` (n_contacts, 2, 4): of
    these the ones of bodies a and b around each contact, as in `anchor_into`.
    """

    points: np.ndarray
    weights: np.ndarray
    first: np.ndarray
    active: np.ndarray


@kernel_without_allocation
def _parts(side, other, spacing):
    """Equal parts of at most ``spacing`` into which the longer of two opposite sides, given by their ends, is cut."""
    longest = np.sqrt(max(dot(side, side), dot(other, other)))
    return max(1, int(np.ceil(longest / spacing - 1e-6)))


@kernel_without_allocation
def _joint_points_into(P, g, n_s, n_t, area, points, clearance, areas):
    """Points over a joint with four corners ``P`` and gaps ``g`` there, as in `joint_points`; their number."""
    count = 0
    for i in range(n_s + 1):
        for j in range(n_t + 1):
            s, t = i / n_s, j / n_t
            weights = ((1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t)
            for axis in range(3):
                points[count, axis] = (
                    weights[0] * P[0, axis] + weights[1] * P[1, axis]
                    + weights[2] * P[2, axis] + weights[3] * P[3, axis]
                )  # fmt: skip
            share = (0.5 if i in (0, n_s) else 1.0) * (0.5 if j in (0, n_t) else 1.0) / (n_s * n_t)
            new = True
            for other in range(count):
                away = difference(points[other], points[count])
                if dot(away, away) < _SAME_POINT * _SAME_POINT:
                    areas[other] += share * area
                    new = False
                    break
            if new:
                clearance[count] = (
                    weights[0] * g[0] + weights[1] * g[1] + weights[2] * g[2] + weights[3] * g[3]
                )
                areas[count] = share * area
                count += 1
    return count


@inner_kernel
def joint_points(corners, gaps, count, spacing):
    """Points over a joint, from its corners.

    ``corners`` (4, 3): in order around the joint [m], of which the first ``count`` are used: 4 of a face, 3 of a
    triangle, 2 of an edge, 1 of a point; ``gaps`` (4,): clearance at each [m]; ``spacing``: largest distance of
    neighbours [m].

    Returns
    -------
    points, clearance, areas : float64 arrays, shape (n, 3), (n,), (n,)
        Clearance bilinear between the corners, as the points are [m]; part of the joint that each stands for, by the
        trapezoidal rule, exact for a parallelogram [m2].
    """
    P = np.empty((4, 3))
    g = np.empty(4)
    for corner in range(4):
        # a triangle's last side and an edge's two ends have no length
        source = min(corner, count - 1) if count != 2 else (0, 1, 1, 0)[corner]
        put_into(corners[source], P[corner])
        g[corner] = gaps[source]
    n_s = _parts(difference(P[1], P[0]), difference(P[2], P[3]), spacing)
    n_t = _parts(difference(P[3], P[0]), difference(P[2], P[1]), spacing)
    area = LEAST_AREA
    for corner in (1, 2):
        x = cross(difference(P[corner], P[0]), difference(P[corner + 1], P[0]))
        area += 0.5 * np.sqrt(dot(x, x))
    points, clearance = np.empty(((n_s + 1) * (n_t + 1), 3)), np.empty((n_s + 1) * (n_t + 1))
    areas = np.empty((n_s + 1) * (n_t + 1))
    n_points = _joint_points_into(P, g, n_s, n_t, area, points, clearance, areas)
    return points[:n_points], clearance[:n_points], areas[:n_points]


@inner_kernel
def _with_capacity(contacts, points, weights, capacity):
    """The contacts so far, with room for more."""
    if capacity <= contacts.gap.size:
        return contacts, points, weights
    more = empty_contacts(2 * capacity)
    copy_into(contacts.body_a, more.body_a)
    copy_into(contacts.body_b, more.body_b)
    copy_into(contacts.gap, more.gap)
    copy_into(contacts.arm_a, more.arm_a)
    copy_into(contacts.arm_b, more.arm_b)
    copy_into(contacts.home, more.home)
    copy_into(contacts.basis, more.basis)
    copy_into(contacts.compliance, more.compliance)
    more_points, more_weights = np.empty((2 * capacity, 2, 4), np.int64), np.empty((2 * capacity, 2, 4))
    copy_into(points, more_points)
    copy_into(weights, more_weights)
    return more, more_points, more_weights


@kernel_without_allocation
def _add_joint_into(
    elastic, placed, rotations, a, b, normal, joint, clearance, areas, margin, layer, admittance, contacts, points,
    weights, count,
):  # fmt: skip
    """Add the points of a joint within ``margin`` to the contacts and anchors, after ``count`` others; their number.

    ``layer``: compliance of the joint's layer [m3/N]; ``admittance`` as of `find_contacts`.
    """
    outward_a, inward_b = transposed_product(rotations[a], normal), transposed_product(rotations[b], normal)
    outward_b = -inward_b[0], -inward_b[1], -inward_b[2]
    for point in range(clearance.size):
        if clearance[point] > margin:
            continue
        compliance = layer / (admittance * areas[point])
        add_contact_into(
            contacts, count, a, b, placed, rotations, normal, joint[point], clearance[point], compliance
        )
        place_b = transposed_product(rotations[b], contacts.arm_b[count])
        anchor_into(elastic, a, contacts.home[count], outward_a, points[count, 0], weights[count, 0])
        anchor_into(elastic, b, place_b, outward_b, points[count, 1], weights[count, 1])
        count += 1
    return count


@inner_kernel
def find_contacts(
    bodies, elastic, polyhedra, placed, rotations, margin, spacing, layers, admittance, memory, n_stoppers
):
    """Contacts of all pairs of deformable bodies, with room for the stoppers after them, and their anchors.

    Parameters
    ----------
    bodies, polyhedra, placed, rotations, margin, layers, admittance, memory, n_stoppers
        As in `detect_contacts`; the polyhedra are without deformation.
    elastic : Elastic
    spacing : float
        The points of a joint [m].

    Returns
    -------
    contacts, anchors : Contacts, Anchors
        Geometry, undeformed gap and compliance filled in; the rows of the stoppers are still empty.
    """
    pairs = find_pairs(placed.low, placed.high, bodies.driven, margin)
    contacts = empty_contacts(64)
    points, weights = np.empty((64, 2, 4), np.int64), np.empty((64, 2, 4))
    normal, corners, gaps, unused = np.empty(3), np.empty((5, 3)), np.empty(5), np.empty(5)
    count = 0
    for pair in range(pairs.shape[0]):
        a, b = pairs[pair, 0], pairs[pair, 1]
        n_corners = detect_pair_into(
            polyhedra, placed, a, b, _WIDE * margin, 0.0, 0.0, memory, normal, corners, gaps, unused
        )
        if n_corners == 0:
            memory[a, b] = -1
            continue
        joint, clearance, areas = joint_points(corners, gaps, n_corners, spacing)
        contacts, points, weights = _with_capacity(contacts, points, weights, count + clearance.size)
        count = _add_joint_into(
            elastic, placed, rotations, a, b, normal, joint, clearance, areas, margin,
            layers[a, b], admittance, contacts, points, weights, count,
        )  # fmt: skip
    contacts, points, weights = _with_capacity(contacts, points, weights, count + n_stoppers)
    points[count : count + n_stoppers] = 0
    weights[count : count + n_stoppers] = 0.0
    total = count + n_stoppers
    first, active = _active_points_into(elastic, points[:count], weights[:count])
    return first_rows(contacts, total), Anchors(points[:total].copy(), weights[:total].copy(), first, active)


@inner_kernel
def _active_points_into(elastic, points, weights):
    """Points that any contact holds on to, and where those of each body begin; ``points`` become places among them."""
    n_bodies = elastic.first_point.size - 1
    place = np.full(elastic.first_point[n_bodies], -1, np.int64)
    for contact in range(points.shape[0]):
        for side in range(2):
            for corner in range(4):
                if weights[contact, side, corner] != 0.0:
                    place[points[contact, side, corner]] = 0
    first, active = np.zeros(n_bodies + 1, np.int64), np.empty(place.size, np.int64)
    count = 0
    for body in range(n_bodies):
        for point in range(elastic.first_point[body], elastic.first_point[body + 1]):
            if place[point] == 0:
                active[count], place[point] = point, count
                count += 1
        first[body + 1] = count
    for contact in range(points.shape[0]):
        for side in range(2):
            for corner in range(4):
                if weights[contact, side, corner] != 0.0:
                    points[contact, side, corner] = place[points[contact, side, corner]]
    return first, active[:count].copy()


@kernel_without_allocation
def tangents_into(rotations, contacts):
    """Complete each contact's basis with tangents that follow body a: they turn with it and never flip."""
    for contact in range(contacts.gap.size):
        basis, R = contacts.basis[contact], rotations[contacts.body_a[contact]]
        n = basis[0]
        inward = transposed_product(R, n)
        across = 0
        for axis in range(1, 3):
            if abs(inward[axis]) > abs(inward[across]) + 1e-6:
                across = axis
        x = R[:, (across + 1) % 3]
        along = dot(x, n)
        size = np.sqrt(dot(x, x) - along * along)
        for axis in range(3):
            basis[1, axis] = (x[axis] - along * n[axis]) / size
        put_into(cross(n, basis[1]), basis[2])


@kernel_without_allocation
def deform_gaps_into(anchors, rotations, displacements, contacts):
    """Add to each gap what the deformation opens it by.

    ``displacements`` (n_active, 3): of the lattice's points that carry contact, body frames [m].
    """
    for contact in range(contacts.gap.size):
        n = contacts.basis[contact, 0]
        for side in range(2):
            body = contacts.body_b[contact] if side else contacts.body_a[contact]
            moved = anchored(anchors, contact, side, displacements)
            inward = transposed_product(rotations[body], n)
            contacts.gap[contact] += (1.0 if side else -1.0) * dot(inward, moved)


@kernel_without_allocation
def anchored(anchors, contact, side, values):
    """Vector at a contact, from those at the lattice's points of one of its bodies; body frame."""
    x, y, z = 0.0, 0.0, 0.0
    for corner in range(4):
        weight = anchors.weights[contact, side, corner]
        if weight != 0.0:
            value = values[anchors.points[contact, side, corner]]
            x += weight * value[0]
            y += weight * value[1]
            z += weight * value[2]
    return x, y, z
