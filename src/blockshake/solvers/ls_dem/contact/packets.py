"""Layout of the near nodes in memory: packets of eight, row by row, so that loops over lanes become vectors."""

from blockshake.jit import kernel_without_allocation

# Packets hold LANES nodes of one side of a pair of bodies, quantity by quantity: entry ``[packet, row + lane]``, with
# the rows below. Written so, a loop over the lanes that touches one or two such arrays becomes vector instructions; a
# slice would be counted, and a flat index checked for its sign, at every packet.
LANES = 8
# Rows of ``Candidates.packets``, of shape (n_packets, PACKET): what a node keeps from step to step. Little of it, since
# walls of many blocks have more packets than the processor's caches hold.
(
    POINT, _, _,  # x, y, z of the place in the owner's frame, from its mass centre [m]
    AREA,  # [m2]
    DAMPING_WEIGHT,  # what the dashpot goes with: the area [m2], or its root [m] in the literal Eq. (3)
    PLACE, _, _,  # in the other body's frame, from the centroid of its shape [m]
    CLOSED,  # change of the place along the normal in the last step [m]
    STRETCH, _, _,  # of the shear spring, in the other body's frame [m]
    HELD,  # energy in the springs [J]; not zero where one is stretched
    PACKET,
) = range(0, 14 * LANES, LANES)  # fmt: skip
# Rows of ``Candidates.located``, of shape (packets of the pair with most, LOCATED): what a step finds out about the
# nodes of the pair at hand.
(
    MOVED, _, _,  # change of the place in the last step [m]
    PHI,  # level-set value there [m]
    NORMAL, _, _,  # outward normal there, in the other body's frame
    INSIDE,  # area of the node if it lies inside, else zero [m2]
    SLOPE,  # length of the level set's gradient there: 1, but near the edges of a sampled one
    FORCE, _, _,  # of the last evaluation on the owner, other's frame [N]
    MOMENT, _, _,  # about the same origin, other's frame [N m]
    SLID, DAMPED, SPRUNG,  # friction heat and dashpot heat of the step, and what the springs hold after it [J]
    BUSY,  # lane 0: not zero where a node lies inside or its spring is stretched
    LOCATED,
) = range(0, 20 * LANES, LANES)  # fmt: skip
# Quantities that a side adds up are those from FORCE on: force, moment, then these.
N_SUMS = (BUSY - FORCE) // LANES
SUM_SLID, SUM_DAMPED, SUM_HELD = 6, 7, 8
# Where a sampled level set puts the values at the eight corners of a cell meanwhile; the forces come after.
CORNERS = FORCE
# A packet is filled up with nodes that lie here [m] and so never touch.
FAR_AWAY = 1e6


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
