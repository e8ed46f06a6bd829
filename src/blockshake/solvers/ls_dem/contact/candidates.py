"""Lists of the nodes that may soon touch a body: they make a step cheap and miss nothing."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.overlap import find_pairs
from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import inner_kernel, kernel, kernel_without_allocation
from blockshake.solvers.ls_dem.contact.carried_over import carry_over_into, earlier_pairs, joints_of
from blockshake.solvers.ls_dem.contact.joint_areas import joint_areas_into
from blockshake.solvers.ls_dem.contact.located_nodes import locate_nodes_into, placed, recall_into, side_pose
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    DAMPING_WEIGHT,
    FAR_AWAY,
    IDLE,
    LANES,
    PHI,
    POINT,
    Packets,
    Span,
    no_packets,
    put_triple,
)
from blockshake.solvers.ls_dem.contact.relative_pose import N_KEY, facing_key, relative_pose_into
from blockshake.solvers.ls_dem.surfaces import level_set

_FRESH = -2  # no key begins so
# A pair sleeps until it has come nearer by this share of its gap, and never with a gap below a share of the skin: it
# then wakes before the step in which it touches, also at a metre a second
_SLEEPS_FOR, _LEAST_GAP = 0.5, 0.05
# A side looks among so many before it for one whose nodes lie alike: a course of a wall repeats itself after fewer
_NEIGHBOURS = 16


class Candidates(NamedTuple):
    """Near nodes, by side of a pair of bodies.

    ``pairs`` int64 (n_pairs, 2), lower index first; ``joint`` int64 (n_pairs,): their rows in `NearPairs`, whose
    ``shift`` (n_pairs, 3) is repeated here. Side ``2 p`` of pair ``p`` holds nodes of its first body against the level
    set of its second, side ``2 p + 1`` the reverse. ``first`` int64 (2 n_pairs + 1,): first packet of each side.
    ``alike`` int64 (2 n_pairs,): its first packet among those of sides alike. ``node`` int64 (n_packets * LANES,):
    index in `Surfaces`, -1 for filling. ``packets``: see `Packets`. ``position`` and ``orientation``: poses for which
    the list was made.

    A pair of which no node can touch yet sleeps: its nodes are not followed, and in a wall with open joints not even
    read. ``reach`` (n_pairs,): way of its two bodies towards each other below which it does [m]; ``asleep`` bool
    (n_pairs,); ``turned`` (n_bodies,): way of any point of a body by its rotation since the list was made, at most, as
    `lists_expired` last found it [m].
    """

    pairs: np.ndarray
    joint: np.ndarray
    shift: np.ndarray
    first: np.ndarray
    alike: np.ndarray
    node: np.ndarray
    packets: Packets
    share: np.ndarray
    key: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    reach: np.ndarray
    asleep: np.ndarray
    turned: np.ndarray


@inner_kernel
def empty_candidates(n_bodies):
    """Lists before the first search."""
    return Candidates(
        np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty((0, 3)), np.zeros(1, np.int64),
        np.empty(0, np.int64), np.empty(0, np.int64), no_packets(0, 0, 0), np.empty(0), np.empty((0, N_KEY), np.int64),
        np.full((n_bodies, 3), np.inf), np.zeros((n_bodies, 4)), np.empty(0), np.empty(0, np.bool_),
        np.zeros(n_bodies),
    )  # fmt: skip


@kernel_without_allocation
def span_of(candidates, pair, side):
    """`Span` of a side."""
    at = 2 * pair + side
    return Span(
        candidates.first[at], candidates.first[at + 1], candidates.first[2 * pair], candidates.alike[at]
    )


@kernel_without_allocation
def lists_expired(candidates, surfaces, driven, position, orientation, skin):
    """Whether a node outside the lists could touch by now.

    A node is in a list when the level set there was below ``skin`` times its steepest slope, so that nothing is missed
    while no two bodies together have moved, with respect to the first driven body, by more than ``skin``.
    """
    base = 0
    while base < driven.size and not driven[base]:
        base += 1
    most, second = 0.0, 0.0
    for body in range(driven.size):
        squared = 0.0
        for axis in range(3):
            shift = position[base, axis] - candidates.position[base, axis] if base < driven.size else 0.0
            moved = position[body, axis] - candidates.position[body, axis] - shift
            squared += moved * moved
        dot = 0.0
        for part in range(4):
            dot += orientation[body, part] * candidates.orientation[body, part]
        # chord of the rotation at the circumscribed sphere: 2 R sin(angle / 2)
        chord = 2.0 * surfaces.radius[body] * np.sqrt(max(1.0 - dot * dot, 0.0))
        bound = np.sqrt(squared) + chord
        candidates.turned[body] = chord
        # not (x <= limit), here and below, so that NaN asks for new lists
        if not (bound <= most):
            second = most
            most = bound
        elif bound > second:
            second = bound
    return not (most + second <= skin)


@inner_kernel
def _boxes(surfaces, position, orientation):
    """Lower and upper corners of the bodies' bounding boxes, (n_bodies, 3) each [m]."""
    n_bodies = position.shape[0]
    low, high = np.empty((n_bodies, 3)), np.empty((n_bodies, 3))
    R = np.empty((3, 3))
    for body in range(n_bodies):
        rotation_matrix_into(orientation[body], R)
        half, middle = surfaces.half[surfaces.shape[body]], surfaces.middle[surfaces.shape[body]]
        for axis in range(3):
            reach = abs(R[axis, 0]) * half[0] + abs(R[axis, 1]) * half[1] + abs(R[axis, 2]) * half[2]
            centre = position[body, axis]
            for along in range(3):
                centre += R[axis, along] * (middle[along] - surfaces.offset[body, along])
            low[body, axis], high[body, axis] = centre - reach, centre + reach
    return low, high


@kernel_without_allocation
def _near_nodes_into(surfaces, pair, pose, side, skin, nodes, count):
    """Write the nodes of one side of a pair within ``skin`` of the other body after ``count`` others; count, gap."""
    owner, other = pair[side], pair[1 - side]
    shape, other_shape = surfaces.shape[owner], surfaces.shape[other]
    gap = skin
    for node in range(surfaces.first_node[shape], surfaces.first_node[shape + 1]):
        p, e = surfaces.points[node], surfaces.offset[owner]
        x, y, z = placed(pose, p[0] - e[0], p[1] - e[1], p[2] - e[2])
        distance = level_set(surfaces, other_shape, x, y, z) / surfaces.steepest[other_shape]
        if distance < skin:
            nodes[count] = node
            count += 1
            gap = min(gap, distance)
    return count, gap


@inner_kernel
def _share(surfaces, driven, owner, other):
    """Share of an interface that the nodes of ``owner`` stand for, in halves: those of both bodies stand for one each.

    A driven box wider than a free body counts none: its nodes, few beneath the body, are where the body's edges happen
    to leave them, and the body's own are an integral over its face.
    """
    if driven[owner] and surfaces.wide[surfaces.shape[owner]] >= surfaces.radius[other]:
        return 0.0
    if driven[other] and surfaces.wide[surfaces.shape[other]] >= surfaces.radius[owner]:
        return 2.0
    return 1.0


@kernel
def find_candidates(surfaces, driven, poses, orientation, skin, old, joints):
    """New lists for these poses, the shear springs of nodes that stay listed carried over.

    Parameters
    ----------
    surfaces, driven : Surfaces, bool array, shape (n_bodies,)
    poses, orientation : Poses, float64 array, shape (n_bodies, 4)
        Poses now and a step before, from where the nodes' next motion counts.
    skin : float
        [m]
    old, joints : Candidates, NearPairs
        Lists and joints so far.

    Returns
    -------
    candidates, joints : Candidates, NearPairs
        Sorted by pair, side and node; with the pairs that have come near for the first time.
    """
    position, rotation = poses.position, poses.rotation
    low, high = _boxes(surfaces, position, orientation)
    pairs = find_pairs(low, high, driven, skin)
    earlier = earlier_pairs(old.pairs, pairs)
    joint, joints = joints_of(pairs, earlier, old.joint, joints)
    shift = joints.shift[joint]
    n_sides = 2 * pairs.shape[0]
    R, d = np.empty((3, 3)), np.empty((2, 3))
    nodes, count = np.empty(1024, np.int64), np.zeros(n_sides + 1, np.int64)
    share, reach = np.empty(n_sides), np.full(pairs.shape[0], np.inf)
    for side in range(n_sides):
        pair, of = pairs[side // 2], side % 2
        count[side + 1] = count[side]
        share[side] = _share(surfaces, driven, pair[of], pair[1 - of])
        if share[side] > 0.0:
            relative_pose_into(position, rotation, surfaces.offset, pair, shift[side // 2], R, d)
            shape = surfaces.shape[pair[of]]
            most = count[side] + surfaces.first_node[shape + 1] - surfaces.first_node[shape]
            if most > nodes.size:
                longer = np.empty(2 * most, np.int64)
                longer[: count[side]] = nodes[: count[side]]
                nodes = longer
            pose = side_pose(R, d, of)
            count[side + 1], gap = _near_nodes_into(surfaces, pair, pose, of, skin, nodes, count[side])
            reach[side // 2] = min(reach[side // 2], _SLEEPS_FOR * gap if gap > _LEAST_GAP * skin else 0.0)
    first = np.zeros(n_sides + 1, np.int64)
    for side in range(n_sides):
        first[side + 1] = first[side] + (count[side + 1] - count[side] + LANES - 1) // LANES
    alike, n_alike = np.zeros(n_sides, np.int64), 0
    for side in range(n_sides):
        like = _side_alike(surfaces, pairs, nodes, count, side)
        alike[side] = n_alike if like == side else alike[like]
        n_alike += first[side + 1] - first[side] if like == side else 0
    node = np.full(first[n_sides] * LANES, -1, np.int64)
    packets = no_packets(n_alike, first[n_sides], _most_packets(first))
    for side in range(n_sides):
        pair, of = pairs[side // 2], side % 2
        e, n_nodes = surfaces.offset[pair[of]], count[side + 1] - count[side]
        for rank in range((first[side + 1] - first[side]) * LANES):
            packet, lane = alike[side] + rank // LANES, rank % LANES
            if rank < n_nodes:
                near = nodes[count[side] + rank]
                node[first[side] * LANES + rank] = near
                p = surfaces.points[near]
                put_triple(packets.alike, packet, POINT, lane, p[0] - e[0], p[1] - e[1], p[2] - e[2])
                packets.alike[packet, AREA + lane] = surfaces.areas[near]
                packets.alike[packet, DAMPING_WEIGHT + lane] = surfaces.damping_weight[near]
            else:
                packets.alike[packet, POINT + lane] = FAR_AWAY
    n_pairs = pairs.shape[0]
    new = Candidates(
        pairs, joint, shift, first, alike, node, packets, share, np.full((n_pairs, N_KEY), _FRESH, np.int64),
        position.copy(), orientation.copy(), reach, np.zeros(n_pairs, np.bool_), np.zeros(position.shape[0]),
    )  # fmt: skip
    for pair in range(n_pairs):
        _recall_into(new, surfaces, poses, pair, R, d)
    carry_over_into(old, earlier, new)
    return new, joints


@inner_kernel
def _most_packets(first):
    """Number of packets of the pair that has most."""
    most = 0
    for side in range(0, first.size - 1, 2):
        most = max(most, first[side + 2] - first[side])
    return most


@inner_kernel
def _side_alike(surfaces, pairs, nodes, count, side):
    """First of the sides before this one, not far before it, whose nodes lie alike; else the side itself."""
    e, n_nodes = surfaces.offset[pairs[side // 2, side % 2]], count[side + 1] - count[side]
    for other in range(max(side - _NEIGHBOURS, 0), side):
        of_other = surfaces.offset[pairs[other // 2, other % 2]]
        same = count[other + 1] - count[other] == n_nodes
        same &= e[0] == of_other[0] and e[1] == of_other[1] and e[2] == of_other[2]
        rank = 0
        while same and rank < n_nodes:
            same = nodes[count[side] + rank] == nodes[count[other] + rank]
            rank += 1
        if same:
            return other
    return side


@inner_kernel
def _recall_into(candidates, surfaces, poses, pair, R, d):
    """Find out what idle packets of a pair did not keep of the step before, and locate the nodes where they are now."""
    for now in range(2):
        position = poses.position if now else poses.position_before
        rotation = poses.rotation if now else poses.rotation_before
        _relate_into(candidates, surfaces, position, rotation, pair, R, d)
        _locate_into(candidates, surfaces, pair, R, d)
        if not now:
            _relate_into(candidates, surfaces, poses.position_earlier, poses.rotation_earlier, pair, R, d)
            for side in range(2):
                recall_into(candidates.packets, span_of(candidates, pair, side), side_pose(R, d, side))


@kernel_without_allocation
def _relate_into(candidates, surfaces, position, rotation, pair, R, d):
    """Pose of a pair's bodies to each other, as `relative_pose_into`."""
    relative_pose_into(
        position, rotation, surfaces.offset, candidates.pairs[pair], candidates.shift[pair], R, d
    )


@kernel_without_allocation
def sleeps(candidates, position, pair):
    """Whether no node of a pair can touch yet with the bodies at ``position``; it is then asleep."""
    reach = candidates.reach[pair]
    if reach == 0.0:
        return False
    a, b = candidates.pairs[pair, 0], candidates.pairs[pair, 1]
    squared = 0.0
    for axis in range(3):
        way = position[a, axis] - candidates.position[a, axis]
        way -= position[b, axis] - candidates.position[b, axis]
        squared += way * way
    if np.sqrt(squared) + candidates.turned[a] + candidates.turned[b] < reach:
        candidates.asleep[pair] = True
        return True
    return False


@kernel_without_allocation
def locate_pair_into(candidates, surfaces, poses, pair, R, d):
    """Locate the nodes of both sides of a pair, awake now; the area in touch, mean of what both sides find [m2].

    The ``located`` packets, ``R`` (3, 3) and ``d`` (2, 3) are overwritten.
    """
    if candidates.asleep[pair]:
        candidates.asleep[pair] = False
        candidates.packets.state[candidates.first[2 * pair] : candidates.first[2 * pair + 2]] = IDLE
    _relate_into(candidates, surfaces, poses.position, poses.rotation, pair, R, d)
    _renew_areas_into(candidates, surfaces, pair, R, d)
    area, woke = _locate_into(candidates, surfaces, pair, R, d)
    if woke:
        _recall_into(candidates, surfaces, poses, pair, R, d)
    return area


@inner_kernel
def _locate_into(candidates, surfaces, pair, R, d):
    """Locate the nodes of both sides of a pair; mean area in touch [m2], and whether a packet is busy that was idle."""
    area, woke = 0.0, False
    for side in range(2):
        of_side, woke_there = locate_nodes_into(
            candidates.packets, span_of(candidates, pair, side), surfaces,
            surfaces.shape[candidates.pairs[pair, 1 - side]], side_pose(R, d, side),
        )  # fmt: skip
        area += 0.5 * of_side
        woke |= woke_there
    return area, woke


@kernel_without_allocation
def _renew_areas_into(candidates, surfaces, pair, R, d):
    """New areas of a pair's nodes where one body has come to another place on the other since they were made."""
    a, b = candidates.pairs[pair, 0], candidates.pairs[pair, 1]
    code, u, v, turn = facing_key(surfaces, a, b, R, d)
    key = candidates.key[pair]
    if code != key[0] or u != key[1] or v != key[2] or turn != key[3]:
        key[0], key[1], key[2], key[3] = code, u, v, turn
        joint_areas_into(candidates, surfaces, pair, key)


@kernel_without_allocation
def nearest_node(candidates, pair):
    """Least level-set value of a pair's nodes, as located [m], with the node's row of ``located`` and its lane."""
    least, at, lane_at = np.inf, 0, 0
    for row in range(candidates.first[2 * pair + 2] - candidates.first[2 * pair]):
        for lane in range(LANES):
            if candidates.packets.located[row, PHI + lane] < least:
                least, at, lane_at = candidates.packets.located[row, PHI + lane], row, lane
    return least, at, lane_at
