"""Places of the nodes of one side of a pair in the other body's frame, and its level set there: Eq. (1)."""

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.trilinear import corner_values, interpolate, locate
from blockshake.jit import borrowing_kernel, inline_kernel
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BUSY,
    CORNERS,
    HELD,
    INSIDE,
    LANES,
    MOVED_X,
    MOVED_Y,
    MOVED_Z,
    NORMAL_X,
    NORMAL_Y,
    NORMAL_Z,
    PHI,
    PLACE_X,
    PLACE_Y,
    PLACE_Z,
    POINT_X,
    POINT_Y,
    POINT_Z,
    SLOPE,
)
from blockshake.solvers.ls_dem.surfaces import (
    COUNT_X,
    COUNT_Y,
    COUNT_Z,
    FIRST,
    INVERSE_SPACING,
    ORIGIN_X,
    ORIGIN_Y,
    ORIGIN_Z,
)


@borrowing_kernel
def locate_nodes_into(packets, first, last, half, chamfer, lattice, values, shape, R, d, side):
    """Locate the nodes of one side.

    Parameters
    ----------
    packets : float64 array, shape (n_packets, PACKET)
        Place, change of place, level-set value, area inside, normal and whether a packet is busy are
        overwritten; by a sampled level set the slope and the forces too.
    first, last : int
        Packets of this side.
    half, chamfer, lattice, values, shape : as in `Surfaces`, int
        Shape whose level set is read.
    R, d, side : float64 arrays, shape (2, 3, 3) and (2, 3), int
        Pose of the owner in the other's frame, from `relative_pose_into`.

    Returns
    -------
    float
        Area of the nodes that lie inside [m2].

    Notes
    -----
    The change is the difference of two places and not a velocity times the step: taken with the
    lever arms of the step's end, the latter would creep by ``dt / 2`` times the centripetal acceleration.
    """
    if lattice[shape, INVERSE_SPACING] == 0.0:
        _locate_in_box_into(packets, first, last, half, chamfer, shape, R, d, side)
    else:
        _locate_in_lattice_into(packets, first, last, lattice, values, shape, R, d, side)
    return _area_inside(packets, first, last)


@borrowing_kernel
def _area_inside(packets, first, last):
    """Area of the nodes that lie inside [m2], added up lane by lane, then as `sum_lanes` does."""
    a, b, c, d, e, f, g, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for packet in range(first, last):
        a += packets[packet, INSIDE]
        b += packets[packet, INSIDE + 1]
        c += packets[packet, INSIDE + 2]
        d += packets[packet, INSIDE + 3]
        e += packets[packet, INSIDE + 4]
        f += packets[packet, INSIDE + 5]
        g += packets[packet, INSIDE + 6]
        h += packets[packet, INSIDE + 7]
    return ((a + b) + (c + d)) + ((e + f) + (g + h))


@inline_kernel
def _pose(R, d, side):
    """Rotation, row by row, and shift from the owner's frame to the other's, as twelve numbers."""
    return (
        R[side, 0, 0], R[side, 0, 1], R[side, 0, 2], R[side, 1, 0], R[side, 1, 1], R[side, 1, 2],
        R[side, 2, 0], R[side, 2, 1], R[side, 2, 2], d[side, 0], d[side, 1], d[side, 2],
    )  # fmt: skip


@inline_kernel
def _follow(packets, packet, lane, pose):
    """Place of a node in the other's frame [m]; it is kept, with its change since the step before."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22, d0, d1, d2 = pose
    px, py = packets[packet, POINT_X + lane], packets[packet, POINT_Y + lane]
    pz = packets[packet, POINT_Z + lane]
    x = r00 * px + r01 * py + r02 * pz + d0
    y = r10 * px + r11 * py + r12 * pz + d1
    z = r20 * px + r21 * py + r22 * pz + d2
    packets[packet, MOVED_X + lane] = x - packets[packet, PLACE_X + lane]
    packets[packet, MOVED_Y + lane] = y - packets[packet, PLACE_Y + lane]
    packets[packet, MOVED_Z + lane] = z - packets[packet, PLACE_Z + lane]
    packets[packet, PLACE_X + lane] = x
    packets[packet, PLACE_Y + lane] = y
    packets[packet, PLACE_Z + lane] = z
    return x, y, z


@borrowing_kernel
def _locate_in_box_into(packets, first, last, half, chamfer, shape, R, d, side):
    """Places, level-set values and normals by the exact distance."""
    a, b, c, leg = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape]
    pose = _pose(R, d, side)
    for packet in range(first, last):
        busy = False
        for lane in range(LANES):
            x, y, z = _follow(packets, packet, lane, pose)
            phi, nx, ny, nz = box_distance(x, y, z, a, b, c, leg)
            packets[packet, PHI + lane] = phi
            packets[packet, NORMAL_X + lane] = nx
            packets[packet, NORMAL_Y + lane] = ny
            packets[packet, NORMAL_Z + lane] = nz
            area = packets[packet, AREA + lane]
            packets[packet, INSIDE + lane] = area if phi < 0.0 else 0.0
            busy |= (phi < 0.0) | (packets[packet, HELD + lane] != 0.0)
        packets[packet, BUSY] = busy


@borrowing_kernel
def _locate_in_lattice_into(packets, first, last, lattice, values, shape, R, d, side):
    """Places, level-set values and normals by trilinear interpolation, with the bits of `grid_distance`.

    Three loops, because a compiler that must assume ``values`` overlaps ``packets`` turns no loop with both
    into vector instructions: so the middle one only moves numbers, and the arithmetic before and after
    it runs on all lanes at once.
    """
    at_first, inverse = lattice[shape, FIRST], lattice[shape, INVERSE_SPACING]
    ox, oy, oz = lattice[shape, ORIGIN_X], lattice[shape, ORIGIN_Y], lattice[shape, ORIGIN_Z]
    n_x, n_y, n_z = lattice[shape, COUNT_X], lattice[shape, COUNT_Y], lattice[shape, COUNT_Z]
    pose = _pose(R, d, side)
    for packet in range(first, last):
        for lane in range(LANES):
            x, y, z = _follow(packets, packet, lane, pose)
            at, fx, fy, fz, beyond = locate(x, y, z, at_first, ox, oy, oz, n_x, n_y, n_z, inverse)
            packets[packet, PHI + lane] = beyond
            packets[packet, NORMAL_X + lane] = fx
            packets[packet, NORMAL_Y + lane] = fy
            packets[packet, NORMAL_Z + lane] = fz
            packets[packet, CORNERS + lane] = at
        for lane in range(LANES):
            (
                packets[packet, CORNERS + lane],
                packets[packet, CORNERS + LANES + lane],
                packets[packet, CORNERS + 2 * LANES + lane],
                packets[packet, CORNERS + 3 * LANES + lane],
                packets[packet, CORNERS + 4 * LANES + lane],
                packets[packet, CORNERS + 5 * LANES + lane],
                packets[packet, CORNERS + 6 * LANES + lane],
                packets[packet, CORNERS + 7 * LANES + lane],
            ) = corner_values(values, packets[packet, CORNERS + lane], n_y, n_z)
        busy = False
        for lane in range(LANES):
            phi, nx, ny, nz, slope = interpolate(
                packets[packet, CORNERS + lane], packets[packet, CORNERS + LANES + lane],
                packets[packet, CORNERS + 2 * LANES + lane], packets[packet, CORNERS + 3 * LANES + lane],
                packets[packet, CORNERS + 4 * LANES + lane], packets[packet, CORNERS + 5 * LANES + lane],
                packets[packet, CORNERS + 6 * LANES + lane], packets[packet, CORNERS + 7 * LANES + lane],
                packets[packet, NORMAL_X + lane], packets[packet, NORMAL_Y + lane], packets[packet, NORMAL_Z + lane],
                packets[packet, PHI + lane], inverse,
            )  # fmt: skip
            packets[packet, SLOPE + lane] = slope
            packets[packet, PHI + lane] = phi
            packets[packet, NORMAL_X + lane] = nx
            packets[packet, NORMAL_Y + lane] = ny
            packets[packet, NORMAL_Z + lane] = nz
            area = packets[packet, AREA + lane]
            packets[packet, INSIDE + lane] = area if phi < 0.0 else 0.0
            busy |= (phi < 0.0) | (packets[packet, HELD + lane] != 0.0)
        packets[packet, BUSY] = busy
