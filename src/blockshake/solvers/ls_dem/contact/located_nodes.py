"""Places of the nodes of one side of a pair in the other body's frame, and its level set there: Eq. (1)."""

import numpy as np

from blockshake.geometry.level_set import box_distance, hollow_box_distance
from blockshake.geometry.level_set_grid import corner_values, interpolate, locate
from blockshake.jit import kernel_without_aliasing, kernel_without_allocation
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BEFORE,
    BUSY,
    CLOSED,
    CORNERS,
    FACTOR,
    IDLE,
    INSIDE,
    LANES,
    NORMAL,
    PHI,
    PLACE,
    POINT,
    SLOPE,
    STRAINED,
    put_triple,
    triple,
)
from blockshake.solvers.ls_dem.surfaces import INVERSE_SPACING, lattice_of


@kernel_without_allocation
def locate_nodes_into(packets, span, surfaces, shape, pose):
    """Locate the nodes of one side; the area of those inside [m2], and whether a packet is busy that was idle.

    Parameters
    ----------
    packets, span : Packets, Span
        The rows of ``located`` are overwritten up to the forces, by a sampled level set these too.
    surfaces, shape : Surfaces, int
        Shape whose level set is read.
    pose : tuple of float
        Pose of the owner in the other's frame, from `side_pose`.
    """
    half, chamfer, hollow = surfaces.half, surfaces.chamfer, surfaces.hollow
    if surfaces.lattice[shape, INVERSE_SPACING] != 0.0:
        _locate_in_lattice_into(packets, span, surfaces.lattice, surfaces.values, shape, pose)
    elif surfaces.first_plane[shape] < surfaces.first_plane[shape + 1]:
        _locate_in_planes_into(packets, span, surfaces.first_plane, surfaces.planes, shape, pose)
    elif hollow[shape] != 0.0:
        _locate_in_hollow_box_into(packets, span, half, chamfer, hollow, shape, pose)
    else:
        _locate_in_box_into(packets, span, half, chamfer, shape, pose)
    return _area_inside(packets, span)


@kernel_without_allocation
def _area_inside(packets, span):
    """Area of the nodes inside [m2], added up lane by lane, then as `sum_lanes` does; whether an idle packet woke."""
    kept, located = packets.kept, packets.located
    a, b, c, d, e, f, g, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    woke = False
    for packet in range(span.first, span.last):
        row = packet - span.start
        if located[row, BUSY] != 0.0:
            woke |= packets.state[packet] == IDLE
            a += kept[packet, FACTOR] * located[row, INSIDE]
            b += kept[packet, FACTOR + 1] * located[row, INSIDE + 1]
            c += kept[packet, FACTOR + 2] * located[row, INSIDE + 2]
            d += kept[packet, FACTOR + 3] * located[row, INSIDE + 3]
            e += kept[packet, FACTOR + 4] * located[row, INSIDE + 4]
            f += kept[packet, FACTOR + 5] * located[row, INSIDE + 5]
            g += kept[packet, FACTOR + 6] * located[row, INSIDE + 6]
            h += kept[packet, FACTOR + 7] * located[row, INSIDE + 7]
    return ((a + b) + (c + d)) + ((e + f) + (g + h)), woke


@kernel_without_allocation
def side_pose(R, d, side):
    """Rotation, row by row, and shift of `relative_pose_into`, owner's frame to the other's, as twelve numbers."""
    if side == 0:
        return (
            R[0, 0], R[1, 0], R[2, 0], R[0, 1], R[1, 1], R[2, 1], R[0, 2], R[1, 2], R[2, 2], d[0, 0], d[0, 1], d[0, 2],
        )  # fmt: skip
    return (
        R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2], d[1, 0], d[1, 1], d[1, 2],
    )  # fmt: skip


@kernel_without_allocation
def placed(pose, px, py, pz):
    """Place in the other's frame of a point of the owner [m]."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22, d0, d1, d2 = pose
    return (
        r00 * px + r01 * py + r02 * pz + d0,
        r10 * px + r11 * py + r12 * pz + d1,
        r20 * px + r21 * py + r22 * pz + d2,
    )


@kernel_without_allocation
def _follow(packets, alike, row, lane, pose):
    """Place of a node in the other's frame [m]; it is written."""
    px, py, pz = triple(packets.alike, alike, POINT, lane)
    x, y, z = placed(pose, px, py, pz)
    put_triple(packets.located, row, PLACE, lane, x, y, z)
    return x, y, z


@kernel_without_allocation
def moved(packets, packet, row, lane):
    """Change of a node's place since the step before [m].

    It is the difference of two places and not a velocity times the step: taken with the lever arms of the step's end,
    the latter would creep by ``dt / 2`` times the centripetal acceleration.
    """
    x, y, z = triple(packets.located, row, PLACE, lane)
    x_before, y_before, z_before = triple(packets.kept, packet, BEFORE, lane)
    return x - x_before, y - y_before, z - z_before


@kernel_without_aliasing
def recall_into(packets, span, pose):
    """Write what nodes of idle packets, which are located where they were a step before, did not keep of that step.

    ``pose``: of the owner in the other's frame two steps before, from `side_pose`.
    """
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        if packets.state[packet] != IDLE:
            continue
        for lane in range(LANES):
            px, py, pz = triple(packets.alike, alike, POINT, lane)
            x, y, z = placed(pose, px, py, pz)
            put_triple(packets.kept, packet, BEFORE, lane, x, y, z)
            ux, uy, uz = moved(packets, packet, row, lane)
            nx, ny, nz = triple(packets.located, row, NORMAL, lane)
            packets.kept[packet, CLOSED + lane] = ux * nx + uy * ny + uz * nz
            x, y, z = triple(packets.located, row, PLACE, lane)
            put_triple(packets.kept, packet, BEFORE, lane, x, y, z)


@kernel_without_allocation
def _find(packets, alike, row, lane, phi, nx, ny, nz, slope):
    """Write value, slope, normal and area inside of a node; whether it is inside."""
    located = packets.located
    located[row, PHI + lane] = phi
    located[row, SLOPE + lane] = slope
    put_triple(located, row, NORMAL, lane, nx, ny, nz)
    located[row, INSIDE + lane] = packets.alike[alike, AREA + lane] if phi < 0.0 else 0.0
    return phi < 0.0


@kernel_without_aliasing
def _locate_in_box_into(packets, span, half, chamfer, shape, pose):
    """Places, level-set values and normals by the exact distance."""
    a, b, c, leg = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape]
    located = packets.located
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        busy = packets.state[packet] == STRAINED
        for lane in range(LANES):
            x, y, z = _follow(packets, alike, row, lane, pose)
            phi, nx, ny, nz = box_distance(x, y, z, a, b, c, leg)
            busy |= _find(packets, alike, row, lane, phi, nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_hollow_box_into(packets, span, half, chamfer, hollow, shape, pose):
    """Places, level-set values and normals by the distance from hollow faces."""
    a, b, c, leg, deep = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape], hollow[shape]
    located = packets.located
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        busy = packets.state[packet] == STRAINED
        for lane in range(LANES):
            x, y, z = _follow(packets, alike, row, lane, pose)
            phi, nx, ny, nz = hollow_box_distance(x, y, z, a, b, c, leg, deep)
            busy |= _find(packets, alike, row, lane, phi, nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_planes_into(packets, span, first_plane, planes, shape, pose):
    """Places, level-set values and normals by the planes of a convex shape's faces."""
    located = packets.located
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        busy = packets.state[packet] == STRAINED
        for lane in range(LANES):
            _follow(packets, alike, row, lane, pose)
            located[row, PHI + lane] = -np.inf
        for plane in range(first_plane[shape], first_plane[shape + 1]):
            px, py, pz, reach = planes[plane, 0], planes[plane, 1], planes[plane, 2], planes[plane, 3]
            for lane in range(LANES):
                x, y, z = triple(located, row, PLACE, lane)
                nx, ny, nz = triple(located, row, NORMAL, lane)
                phi, out = located[row, PHI + lane], px * x + py * y + pz * z - reach
                farther = out > phi
                nx, ny, nz = px if farther else nx, py if farther else ny, pz if farther else nz
                put_triple(located, row, NORMAL, lane, nx, ny, nz)
                located[row, PHI + lane] = out if farther else phi
        for lane in range(LANES):
            nx, ny, nz = triple(located, row, NORMAL, lane)
            busy |= _find(packets, alike, row, lane, located[row, PHI + lane], nx, ny, nz, 1.0)
        located[row, BUSY] = busy


@kernel_without_aliasing
def _locate_in_lattice_into(packets, span, lattice, values, shape, pose):
    """Places, level-set values and normals by trilinear interpolation, with the bits of `grid_distance`.

    Three loops, because a compiler that must assume ``values`` overlaps the packets turns no loop with both
    into vector instructions: so the middle one only moves numbers, and the arithmetic before and after
    it runs on all lanes at once.
    """
    at_first, ox, oy, oz, n_x, n_y, n_z, inverse = lattice_of(lattice, shape)
    located = packets.located
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        for lane in range(LANES):
            x, y, z = _follow(packets, alike, row, lane, pose)
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
        busy = packets.state[packet] == STRAINED
        for lane in range(LANES):
            fx, fy, fz = triple(located, row, NORMAL, lane)
            phi, nx, ny, nz, slope = interpolate(
                located[row, CORNERS + lane], located[row, CORNERS + LANES + lane],
                located[row, CORNERS + 2 * LANES + lane], located[row, CORNERS + 3 * LANES + lane],
                located[row, CORNERS + 4 * LANES + lane], located[row, CORNERS + 5 * LANES + lane],
                located[row, CORNERS + 6 * LANES + lane], located[row, CORNERS + 7 * LANES + lane],
                fx, fy, fz, located[row, PHI + lane], inverse,
            )  # fmt: skip
            busy |= _find(packets, alike, row, lane, phi, nx, ny, nz, slope)
        located[row, BUSY] = busy
