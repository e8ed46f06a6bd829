"""Which nodes may touch which body soon: the lists that make a step cheap and miss nothing."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import kernel

# A packet holds LANES nodes, row by row in one piece of memory, so that the compiler turns a loop over the
# lanes into vector instructions without asking whether rows overlap; entry ``row + lane``, with these rows:
LANES = 8
PX, PY, PZ, AREA, SHEAR_X, SHEAR_Y, SHEAR_Z, PHI = 0, 8, 16, 24, 32, 40, 48, 56
RESULT = 64  # nine rows of results of the last evaluation, see `contact.side_forces_into`
PACKET = 136
# A packet is filled up with nodes that lie here [m] and so never touch.
FAR_AWAY = 1e6


class Surfaces(NamedTuple):
    """Shapes as LS-DEM reads them.

    ``shape`` int64 (n_bodies,): shape of each body. ``half`` (n_shapes, 3), ``chamfer``
    (n_shapes,) and ``radius`` (n_shapes,): half edges, chamfer and circumscribed radius [m].
    ``first_node`` int64 (n_shapes + 1,), ``points`` (n_nodes, 3), ``areas`` (n_nodes,): surface
    nodes in the body frame [m, m2].
    """

    shape: np.ndarray
    half: np.ndarray
    chamfer: np.ndarray
    radius: np.ndarray
    first_node: np.ndarray
    points: np.ndarray
    areas: np.ndarray


class Candidates(NamedTuple):
    """Near nodes, by side of a pair of bodies.

    Side ``2 p`` of pair ``p`` holds nodes of its first body against the level set of its
    second, side ``2 p + 1`` the reverse. ``first`` int64 (2 n_pairs + 1,): first packet of each
    side. ``node`` int64 (n_packets * LANES,): index in `Surfaces`, -1 for filling. ``packets``
    float64 (n_packets * PACKET,): position in the owner's frame [m], area [m2], shear force in
    the other body's frame [N], level-set value [m]. ``position`` and ``orientation``: poses for
    which the list was made.
    """

    pairs: np.ndarray
    first: np.ndarray
    node: np.ndarray
    packets: np.ndarray
    position: np.ndarray
    orientation: np.ndarray


@kernel
def empty_candidates(n_bodies):
    """Lists before the first search."""
    return Candidates(
        np.empty((0, 2), np.int64),
        np.zeros(1, np.int64),
        np.empty(0, np.int64),
        np.empty(0),
        np.full((n_bodies, 3), np.inf),
        np.zeros((n_bodies, 4)),
    )


@kernel
def lists_expired(candidates, surfaces, driven, position, orientation, skin):
    """Whether a node outside the lists could touch by now.

    A node is in a list when the level set there was below ``skin``. Level sets change by at most
    the distance moved, so that nothing is missed while no two bodies together have moved, with
    respect to the first driven body, by more than ``skin``.
    """
    shift = np.zeros(3)
    for body in range(driven.size):
        if driven[body]:
            for axis in range(3):
                shift[axis] = position[body, axis] - candidates.position[body, axis]
            break
    most, second = 0.0, 0.0
    for body in range(driven.size):
        squared = 0.0
        for axis in range(3):
            moved = position[body, axis] - candidates.position[body, axis] - shift[axis]
            squared += moved * moved
        dot = 0.0
        for part in range(4):
            dot += orientation[body, part] * candidates.orientation[body, part]
        # chord of the rotation at the circumscribed sphere: 2 R sin(angle / 2)
        chord = 2.0 * surfaces.radius[surfaces.shape[body]] * np.sqrt(max(1.0 - dot * dot, 0.0))
        bound = np.sqrt(squared) + chord
        if bound > most:
            second = most
            most = bound
        elif bound > second:
            second = bound
    # not (x <= skin), so that NaN asks for new lists
    return not (most + second <= skin)


@kernel
def find_pairs(surfaces, driven, position, orientation, skin):
    """Pairs of bodies whose bounding boxes come within ``skin``: int64 (n_pairs, 2), sorted.

    Sweep along x over the sorted lower ends, so that the cost grows with the bodies and the
    neighbours of each.
    """
    n_bodies = driven.size
    low, high = np.empty((n_bodies, 3)), np.empty((n_bodies, 3))
    R = np.empty((3, 3))
    for body in range(n_bodies):
        rotation_matrix_into(orientation[body], R)
        half = surfaces.half[surfaces.shape[body]]
        for axis in range(3):
            reach = abs(R[axis, 0]) * half[0] + abs(R[axis, 1]) * half[1] + abs(R[axis, 2]) * half[2]
            low[body, axis] = position[body, axis] - reach - 0.5 * skin
            high[body, axis] = position[body, axis] + reach + 0.5 * skin
    order = np.argsort(low[:, 0], kind="mergesort")
    codes = []
    for rank in range(n_bodies):
        a = order[rank]
        for later in range(rank + 1, n_bodies):
            b = order[later]
            if low[b, 0] > high[a, 0]:
                break
            if driven[a] and driven[b]:
                continue
            if (
                low[a, 1] <= high[b, 1]
                and low[b, 1] <= high[a, 1]
                and low[a, 2] <= high[b, 2]
                and low[b, 2] <= high[a, 2]
            ):
                codes.append(min(a, b) * n_bodies + max(a, b))
    sorted_codes = np.sort(np.array(codes, dtype=np.int64)) if len(codes) > 0 else np.empty(0, np.int64)
    pairs = np.empty((sorted_codes.size, 2), np.int64)
    for pair in range(sorted_codes.size):
        pairs[pair, 0] = sorted_codes[pair] // n_bodies
        pairs[pair, 1] = sorted_codes[pair] % n_bodies
    return pairs


@kernel
def _select_into(surfaces, owner, other, position, orientation, skin, chosen):
    """Nodes of ``owner`` below ``skin`` in the level set of ``other``; their number is returned."""
    R_owner, R_other = np.empty((3, 3)), np.empty((3, 3))
    rotation_matrix_into(orientation[owner], R_owner)
    rotation_matrix_into(orientation[other], R_other)
    R = R_other.T @ R_owner
    d = R_other.T @ (position[owner] - position[other])
    shape, other_shape = surfaces.shape[owner], surfaces.shape[other]
    half, chamfer = surfaces.half[other_shape], surfaces.chamfer[other_shape]
    count = 0
    for node in range(surfaces.first_node[shape], surfaces.first_node[shape + 1]):
        p = surfaces.points[node]
        x = R[0, 0] * p[0] + R[0, 1] * p[1] + R[0, 2] * p[2] + d[0]
        y = R[1, 0] * p[0] + R[1, 1] * p[1] + R[1, 2] * p[2] + d[1]
        z = R[2, 0] * p[0] + R[2, 1] * p[1] + R[2, 2] * p[2] + d[2]
        phi, _, _, _ = box_distance(x, y, z, half[0], half[1], half[2], chamfer)
        if phi < skin:
            chosen[count] = node
            count += 1
    return count


@kernel
def find_candidates(surfaces, driven, position, orientation, skin, old):
    """New lists for these poses, the shear forces of nodes that stay listed carried over.

    Parameters
    ----------
    surfaces : Surfaces
    driven : bool array, shape (n_bodies,)
    position, orientation : float64 arrays, shape (n_bodies, 3) and (n_bodies, 4)
    skin : float
        [m]
    old : Candidates
        Lists so far.

    Returns
    -------
    Candidates
        Sorted by pair, side and node.
    """
    pairs = find_pairs(surfaces, driven, position, orientation, skin)
    n_sides = 2 * pairs.shape[0]
    chosen = np.empty((n_sides, surfaces.points.shape[0]), np.int64)
    count = np.empty(n_sides, np.int64)
    first = np.zeros(n_sides + 1, np.int64)
    for side in range(n_sides):
        owner, other = pairs[side // 2, side % 2], pairs[side // 2, 1 - side % 2]
        count[side] = _select_into(surfaces, owner, other, position, orientation, skin, chosen[side])
        first[side + 1] = first[side] + (count[side] + LANES - 1) // LANES
    node = np.full(first[n_sides] * LANES, -1, np.int64)
    packets = np.zeros(first[n_sides] * PACKET)
    for side in range(n_sides):
        for place in range(first[side] * LANES, first[side + 1] * LANES):
            entry = _entry(place)
            rank = place - first[side] * LANES
            if rank < count[side]:
                node[place] = chosen[side, rank]
                for axis in range(3):
                    packets[entry + PX + axis * LANES] = surfaces.points[node[place], axis]
                packets[entry + AREA] = surfaces.areas[node[place]]
            else:
                packets[entry + PX] = FAR_AWAY
                packets[entry + AREA] = 1.0
    new = Candidates(pairs, first, node, packets, position.copy(), orientation.copy())
    _carry_over_into(old, new)
    return new


@kernel
def _entry(place):
    """Index in ``packets`` of row 0 of the node at this place of ``node``."""
    return (place // LANES) * PACKET + place % LANES


@kernel
def _carry_over_into(old, new):
    """Shear forces of nodes that both lists hold; both are sorted, so one pass finds them."""
    old_pair = 0
    for pair in range(new.pairs.shape[0]):
        while old_pair < old.pairs.shape[0] and (
            old.pairs[old_pair, 0] < new.pairs[pair, 0]
            or (old.pairs[old_pair, 0] == new.pairs[pair, 0] and old.pairs[old_pair, 1] < new.pairs[pair, 1])
        ):
            old_pair += 1
        if old_pair == old.pairs.shape[0]:
            return
        if old.pairs[old_pair, 0] != new.pairs[pair, 0] or old.pairs[old_pair, 1] != new.pairs[pair, 1]:
            continue
        for side in range(2):
            place = old.first[2 * old_pair + side] * LANES
            end = old.first[2 * old_pair + side + 1] * LANES
            for here in range(new.first[2 * pair + side] * LANES, new.first[2 * pair + side + 1] * LANES):
                while place < end and old.node[place] != -1 and old.node[place] < new.node[here]:
                    place += 1
                if place < end and new.node[here] != -1 and old.node[place] == new.node[here]:
                    for row in (SHEAR_X, SHEAR_Y, SHEAR_Z):
                        new.packets[_entry(here) + row] = old.packets[_entry(place) + row]
