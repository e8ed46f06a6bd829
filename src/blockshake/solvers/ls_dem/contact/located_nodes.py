"""Places of the nodes of one side of a pair in the other body's frame, and its level set there: Eq. (1)."""

import numpy as np

from blockshake.geometry.level_set import box_distance, hollow_box_distance
from blockshake.geometry.level_set_grid import corner_values, interpolate, locate
from blockshake.jit import kernel_without_aliasing, kernel_without_allocation
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BUSY,
    CORNERS,
    HELD,
    INSIDE,
    LANES,
    MOVED,
    NORMAL,
    PHI,
    PLACE,
    POINT,
    SLOPE,
    put_triple,
    triple,
)
from blockshake.solvers.ls_dem.surfaces import INVERSE_SPACING, lattice_of


@kernel_without_allocation
def locate_nodes_into(packets, located, first, last, start, surfaces, shape, R, d, side):
    """Locate the nodes of one side; the area of those that lie inside is returned [m2].

    Parameters
    ----------
    packets : float64 array, shape (n_packets, PACKET)
        The nodes' places are overwritten.
    located : float64 array, shape (packets of the pair with most, LOCATED)
        Change of place, level-set value, slope, area inside, normal and whether a packet is busy are
        overwritten; by a sampled level set the forces too.
    first, last, start : int
        Packets of this side; first packet of the pair, whose row of ``located`` is the first.
    surfaces, shape : Surfaces, int
        Shape whose level set is read.
    R, d, side : float64 arrays, shape (2, 3, 3) and (2, 3), int
        Pose of the owner in the other's frame, from `relative_pose_into`.

    Notes
    -----
    The change is the difference of two places and not a velocity times the step: taken with the
    lever arms of the step's end, the latter would creep by ``dt / 2`` times the centripetal acceleration.
    """
    half, chamfer, hollow = surfaces.half, surfaces.chamfer, surfaces.hollow
    if surfaces.lattice[shape, INVERSE_SPACING] != 0.0:
        _locate_in_lattice_into(
            packets, located, first, last, start, surfaces.lattice, surfaces.values, shape, R, d, side
        )
    elif surfaces.first_plane[shape] < surfaces.first_plane[shape + 1]:
        _locate_in_planes_into(
            packets, located, first, last, start, surfaces.first_plane, surfaces.planes, shape, R, d, side
        )
    elif hollow[shape] != 0.0:
        _locate_in_hollow_box_into(
            packets, located, first, last, start, half, chamfer, hollow, shape, R, d, side
        )
    else:
        _locate_in_box_into(packets, located, first, last, start, half, chamfer, shape, R, d, side)
    return _area_inside(located, first - start, last - start)


@kernel_without_allocation
def _area_inside(located, first, last):
    """Area of the nodes that lie inside [m2], added up lane by lane, then as `sum_lanes` does."""
    a, b, c, d, e, f, g, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for row in range(first, last):
        a += located[row, INSIDE]
        b += located[row, INSIDE + 1]
        c += located[row, INSIDE + 2]
        d += located[row, INSIDE + 3]
        e += located[row, INSIDE + 4]
        f += located[row, INSIDE + 5]
        g += located[row, INSIDE + 6]
        h += located[row, INSIDE + 7]
    return ((a + b) + (c + d)) + ((e + f) + (g + h))


@kernel_without_allocation
def _pose(R, d, side):
    """Rotation, row by row, and shift from the owner's frame to the other's, as twelve numbers."""
    return (
        R[side, 0, 0], R[side, 0, 1], R[side, 0, 2], R[side, 1, 0], R[side, 1, 1], R[side, 1, 2],
        R[side, 2, 0], R[side, 2, 1], R[side, 2, 2], d[side, 0], d[side, 1], d[side, 2],
    )  # fmt: skip


@kernel_without_allocation
def _follow(packets, packet, located, row, lane, pose):
    """Place of a node in the other's frame [m]; it is kept, with its change since the step before."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22, d0, d1, d2 = pose
    px, py, pz = triple(packets, packet, POINT, lane)
    x = r00 * px + r01 * py + r02 * pz + d0
    y = r10 * px + r11 * py + r12 * pz + d1
    z = r20 * px + r21 * py + r22 * pz + d2
    x_before, y_before, z_before = triple(packets, packet, PLACE, lane)
    put_triple(located, row, MOVED, lane, x - x_before, y - y_before, z - z_before)
    put_triple(packets, packet, PLACE, lane, x, y, z)
    return x, y, z


@kernel_without_allocation
def _find(packets, packet, located, row, lane, phi, nx, ny, nz, slope):
    """Write value, slope, normal and area inside of a node; whether it is inside or its spring is stretched."""
    located[row, PHI + lane] = phi
    located[row, SLOPE + lane] = slope
    put_triple(located, row, NORMAL, lane, nx, ny, nz)
    located[row, INSIDE + lane] = packets[packet, AREA + lane] if phi < 0.0 else 0.0
    return (phi < 0.0) | (packets[packet, HELD + lane] != 0.0)


@kernel_without_aliasing
def _locate_in_box_into(packets, located, first, last, start, half, chamfer, shape, R, d, side):
    """Places, level-set values and normals by the exact distance."""
    a, b, c, leg = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape]
    pose = _pose(R, d, side)
    for packet in range(first, last):
        busy, row = False, packet - start
        for lane in range(LANES):
            x, y, z = _follow(packets, packet, located, row, lane, pose)
            phi, nx, ny, nz = box_distance(x, y, z, a, b, c, leg)
            busy |= _find(packets, packet, located, row, lane, phi, nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_hollow_box_into(
    packets, located, first, last, start, half, chamfer, hollow, shape, R, d, side
):
    """Places, level-set values and normals by the distance from hollow faces."""
    a, b, c, leg, deep = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape], hollow[shape]
    pose = _pose(R, d, side)
    for packet in range(first, last):
        busy, row = False, packet - start
        for lane in range(LANES):
            x, y, z = _follow(packets, packet, located, row, lane, pose)
            phi, nx, ny, nz = hollow_box_distance(x, y, z, a, b, c, leg, deep)
            busy |= _find(packets, packet, located, row, lane, phi, nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_planes_into(packets, located, first, last, start, first_plane, planes, shape, R, d, side):
    """Places, level-set values and normals by the planes of a convex shape's faces."""
    pose = _pose(R, d, side)
    for packet in range(first, last):
        busy, row = False, packet - start
        for lane in range(LANES):
            _follow(packets, packet, located, row, lane, pose)
            located[row, PHI + lane] = -np.inf
        for plane in range(first_plane[shape], first_plane[shape + 1]):
            px, py, pz, reach = planes[plane, 0], planes[plane, 1], planes[plane, 2], planes[plane, 3]
            for lane in range(LANES):
                x, y, z = triple(packets, packet, PLACE, lane)
                nx, ny, nz = triple(located, row, NORMAL, lane)
                phi, out = located[row, PHI + lane], px * x + py * y + pz * z - reach
                farther = out > phi
                nx, ny, nz = px if farther else nx, py if farther else ny, pz if farther else nz
                put_triple(located, row, NORMAL, lane, nx, ny, nz)
                located[row, PHI + lane] = out if farther else phi
        for lane in range(LANES):
            nx, ny, nz = triple(located, row, NORMAL, lane)
            busy |= _find(packets, packet, located, row, lane, located[row, PHI + lane], nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_lattice_into(packets, located, first, last, start, lattice, values, shape, R, d, side):
    """Places, level-set values and normals by trilinear interpolation, with the bits of `grid_distance`.

    Three loops, because a compiler that must assume ``values`` overlaps the packets turns no loop with both
    into vector instructions: so the middle one only moves numbers, and the arithmetic before and after
    it runs on all lanes at once.
    """
    at_first, ox, oy, oz, n_x, n_y, n_z, inverse = lattice_of(lattice, shape)
    pose = _pose(R, d, side)
    for packet in range(first, last):
        row = packet - start
        for lane in range(LANES):
            x, y, z = _follow(packets, packet, located, row, lane, pose)
            at, fx, fy, fz, beyond = locate(x, y, z, at_first, ox, oy, oz, n_x, n_y, n_z, inverse)
            located[row, PHI + lane] = beyond
            put_triple(located, row, NORMAL, lane, fx, fy, fz)
            located[row, CORNERS + lane] = at
        for lane in range(LANES):
            (
                located[row, CORNERS + lane],
                located[row, CORNERS + LANES + lane],
                located[row, CORNERS + 2 * LANES + lane],
                located[row, CORNERS + 3 * LANES + lane],
                located[row, CORNERS + 4 * LANES + lane],
                located[row, CORNERS + 5 * LANES + lane],
                located[row, CORNERS + 6 * LANES + lane],
                located[row, CORNERS + 7 * LANES + lane],
            ) = corner_values(values, located[row, CORNERS + lane], n_y, n_z)
        busy = False
        for lane in range(LANES):
            fx, fy, fz = triple(located, row, NORMAL, lane)
            phi, nx, ny, nz, slope = interpolate(
                located[row, CORNERS + lane], located[row, CORNERS + LANES + lane],
                located[row, CORNERS + 2 * LANES + lane], located[row, CORNERS + 3 * LANES + lane],
                located[row, CORNERS + 4 * LANES + lane], located[row, CORNERS + 5 * LANES + lane],
                located[row, CORNERS + 6 * LANES + lane], located[row, CORNERS + 7 * LANES + lane],
                fx, fy, fz, located[row, PHI + lane], inverse,
            )  # fmt: skip
            busy |= _find(packets, packet, located, row, lane, phi, nx, ny, nz, slope)
        located[row, BUSY] = busy
