"""Joints, and springs of nodes that stay listed: taken over from earlier lists of near nodes by new ones."""

import numpy as np

from blockshake.jit import inner_kernel
from blockshake.solvers.ls_dem.contact.packets import (
    BUSY_BEFORE,
    CLOSED,
    IDLE,
    KEPT,
    LANES,
    STRAINED,
    STRETCH,
)
from blockshake.solvers.ls_dem.progress import add_joints, find_joint


@inner_kernel
def earlier_pairs(old, pairs):
    """Row of every pair in an earlier list, -1 where it is not there; both are sorted, so one pass finds them."""
    earlier, at = np.full(len(pairs), -1), 0
    for pair in range(len(pairs)):
        a, b = pairs[pair, 0], pairs[pair, 1]
        while at < len(old) and (old[at, 0] < a or (old[at, 0] == a and old[at, 1] < b)):
            at += 1
        if at < len(old) and old[at, 0] == a and old[at, 1] == b:
            earlier[pair] = at
    return earlier


@inner_kernel
def joints_of(pairs, earlier, old, joints):
    """Joint of every pair, that of an earlier approach or a new one, and all joints; ``old``: of earlier pairs."""
    joint, fresh = np.empty(len(pairs), np.int64), np.empty(len(pairs), np.int64)
    n_fresh = 0
    for pair in range(len(pairs)):
        joint[pair] = (
            old[earlier[pair]] if earlier[pair] >= 0 else find_joint(joints, pairs[pair, 0], pairs[pair, 1])
        )
        if joint[pair] < 0:
            joint[pair] = joints.slip.size + n_fresh
            fresh[n_fresh] = pair
            n_fresh += 1
    return joint, add_joints(joints, pairs[fresh[:n_fresh]])


@inner_kernel
def carry_over_into(old, earlier, new):
    """Springs of nodes in both lists, of which no pair sleeps; these are sorted, so one pass a side finds them."""
    for pair in range(new.pairs.shape[0]):
        if earlier[pair] < 0:
            continue
        for side in range(2):
            slot = old.first[2 * earlier[pair] + side] * LANES
            end = old.first[2 * earlier[pair] + side + 1] * LANES
            for here in range(new.first[2 * pair + side] * LANES, new.first[2 * pair + side + 1] * LANES):
                while slot < end and old.node[slot] != -1 and old.node[slot] < new.node[here]:
                    slot += 1
                if slot < end and new.node[here] != -1 and old.node[slot] == new.node[here]:
                    source, target = old.packets.kept[slot // LANES], new.packets.kept[here // LANES]
                    state = old.packets.state[slot // LANES]
                    for row in range(CLOSED, KEPT if state != IDLE else CLOSED, LANES):
                        target[row + here % LANES] = source[row + slot % LANES]
                        if row >= STRETCH and target[row + here % LANES] != 0.0:
                            new.packets.state[here // LANES] = STRAINED
                            new.reach[pair] = 0.0
                    new.packets.state[here // LANES] = max(
                        new.packets.state[here // LANES], min(state, BUSY_BEFORE)
                    )
