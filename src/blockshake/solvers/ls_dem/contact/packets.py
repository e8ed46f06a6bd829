"""Layout of the near nodes in memory: packets of eight, row by row, so that loops over lanes become vectors."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import inner_kernel, kernel_without_allocation

# Packets hold LANES nodes of one side of a pair of bodies, quantity by quantity: entry ``[packet, row + lane]``, with
# the rows below. Written so, a loop over the lanes becomes vector instructions; a slice would be counted, and a flat
# index checked for its sign, at every packet.
LANES = 8
# Rows of ``Packets.alike``: what nodes are by their shape.
(
    POINT, _, _,  # x, y, z of the place in the owner's frame, from its mass centre [m]
    AREA,  # [m2]
    DAMPING_WEIGHT,  # what the dashpot goes with: the area [m2], or its root [m] in the literal Eq. (3)
    ALIKE,
) = range(0, 6 * LANES, LANES)  # fmt: skip
# Rows of ``Packets.kept``: what a node keeps from step to step, as long as its packet is busy.
(
    FACTOR,  # of its area and damping weight in this joint [1]
    BEFORE, _, _,  # place in the last step, in the other body's frame, from the centroid of its shape [m]
    CLOSED,  # change of the place along the normal in the last step [m]
    STRETCH, _, _,  # of the shear spring, in the other body's frame [m]
    KEPT,
) = range(0, 9 * LANES, LANES)  # fmt: skip
# States of a packet after a step: it was idle; it was busy, since a node lay inside or a spring was stretched before;
# and it is so still.
IDLE, BUSY_BEFORE, STRAINED = 0, 1, 2
# Rows of ``Packets.located``: what a step finds out about the nodes of the pair at hand.
(
    PLACE, _, _,  # now [m]
    MOVED, _, _,  # change of the place in the last step, of busy packets [m]
    PHI,  # level-set value there [m]
    NORMAL, _, _,  # outward normal there, in the other body's frame
    INSIDE,  # area of the node if it lies inside, else zero, before the factor [m2]
    SLOPE,  # length of the level set's gradient there: 1, but near the edges of a sampled one
    FORCE, _, _,  # of the last evaluation on the owner, other's frame [N]
    MOMENT, _, _,  # about the same origin, other's frame [N m]
    SLID, DAMPED, SPRUNG,  # friction heat and dashpot heat of the step, and what the springs hold after it [J]
    BUSY,  # lane 0: not zero where a node lies inside or its spring is stretched
    LOCATED,
) = range(0, 23 * LANES, LANES)  # fmt: skip
# Quantities that a side adds up are those from FORCE on: force, moment, then these.
N_SUMS = (BUSY - FORCE) // LANES
SUM_SLID, SUM_DAMPED, SUM_HELD = 6, 7, 8
# Where a sampled level set puts the values at the eight corners of a cell meanwhile; the forces come after.
CORNERS = FORCE
# A packet is filled up with nodes that lie here [m] and so never touch.
FAR_AWAY = 1e6


class Packets(NamedTuple):
    """Near nodes in packets, see the rows above.

    ``alike`` (n, ALIKE): of sides whose nodes lie alike once, since walls of many blocks have more packets than the
    processor's caches hold. ``kept`` (n_packets, KEPT), which is neither read nor written while a packet is idle.
    ``state`` uint8 (n_packets,): after the last step, see above. ``located`` (packets of the pair with most, LOCATED):
    workspace of the pair at hand.
    """

    alike: np.ndarray
    kept: np.ndarray
    state: np.ndarray
    located: np.ndarray


@inner_kernel
def no_packets(n_alike, n_packets, most):
    """Packets of nothing, all zero."""
    return Packets(
        cache_lines(n_alike, ALIKE), cache_lines(n_packets, KEPT), np.full(n_packets, IDLE, np.uint8),
        cache_lines(most, LOCATED),
    )  # fmt: skip


@inner_kernel
def cache_lines(n, width):
    """Zeros, shape (n, width), of which every eight are a line of the processor's cache, if the width is of eights."""
    room = np.zeros(n * width + LANES)
    skipped = -room.ctypes.data % (8 * LANES) // 8
    return room[skipped : skipped + n * width].reshape((n, width))


class Span(NamedTuple):
    """Packets of one side of a pair: ``first`` to before ``last``; the pair's first; the side's first in ``alike``."""

    first: int
    last: int
    start: int
    alike: int


@kernel_without_allocation
def triple(table, row, first, lane):
    """The x, y and z of one node in packets or located nodes."""
    return table[row, first + lane], table[row, first + LANES + lane], table[row, first + 2 * LANES + lane]


@kernel_without_allocation
def put_triple(table, row, first, lane, x, y, z):
    """Write the x, y and z of one node."""
    table[row, first + lane] = x
    table[row, first + LANES + lane] = y
    table[row, first + 2 * LANES + lane] = z


@kernel_without_allocation
def add_triple(table, row, first, lane, x, y, z):
    """Add to the x, y and z of one node."""
    table[row, first + lane] += x
    table[row, first + LANES + lane] += y
    table[row, first + 2 * LANES + lane] += z


@kernel_without_allocation
def sum_lanes(lanes, row):
    """Sum of eight entries, in a fixed order."""
    return ((lanes[row] + lanes[row + 1]) + (lanes[row + 2] + lanes[row + 3])) + (
        (lanes[row + 4] + lanes[row + 5]) + (lanes[row + 6] + lanes[row + 7])
    )
