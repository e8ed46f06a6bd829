"""Forces of the located nodes of one side of a pair of bodies: the law at each, and their sum, Eq. (6)."""

import numpy as np

from blockshake.jit import separate_kernel
from blockshake.solvers.ls_dem.contact.contact_law import node_force
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BUSY,
    CLOSED,
    DAMPED,
    DAMPING_WEIGHT,
    FORCE,
    HELD,
    LANES,
    MOMENT,
    MOVED,
    N_SUMS,
    NORMAL,
    PHI,
    PLACE,
    SLID,
    SLOPE,
    SPRUNG,
    STRETCH,
    add_triple,
    put_triple,
    sum_lanes,
    triple,
)


@separate_kernel
def side_forces_into(packets, located, first, last, start, law, gamma_s, lanes, sums):
    """Forces of the nodes of one side, summed.

    Parameters
    ----------
    packets : float64 array, shape (n_packets, PACKET)
        The nodes' springs are updated.
    located, first, last, start
        As of `locate_nodes_into`; the forces are overwritten.
    law : Law
    gamma_s : float
        Dashpot beside the shear springs, per unit of a node's damping weight.
    lanes : float64 array, shape (N_SUMS * LANES,)
        Workspace.
    sums : float64 array, shape (N_SUMS,)
        Overwritten: force and moment about the centroid of the other's shape, on the owner, other's
        frame [N, N m]; friction heat and dashpot heat of this step, and elastic energy held [J].

    Notes
    -----
    A packet in which no node touches and no spring is stretched has no force.
    """
    lanes[:] = 0.0
    for packet in range(first, last):
        row = packet - start
        if located[row, BUSY] == 0.0:
            for lane in range(LANES):
                ux, uy, uz = triple(located, row, MOVED, lane)
                nx, ny, nz = triple(located, row, NORMAL, lane)
                packets[packet, CLOSED + lane] = ux * nx + uy * ny + uz * nz
            continue
        for lane in range(LANES):
            nx, ny, nz = triple(located, row, NORMAL, lane)
            ux, uy, uz = triple(located, row, MOVED, lane)
            ox, oy, oz = triple(packets, packet, STRETCH, lane)
            fx, fy, fz, sx, sy, sz, closed, held, slid, damped = node_force(
                located[row, PHI + lane], located[row, SLOPE + lane], nx, ny, nz, ux, uy, uz, ox, oy, oz,
                packets[packet, CLOSED + lane], packets[packet, AREA + lane], packets[packet, DAMPING_WEIGHT + lane],
                law,
            )  # fmt: skip
            x, y, z = triple(packets, packet, PLACE, lane)
            put_triple(packets, packet, STRETCH, lane, sx, sy, sz)
            packets[packet, CLOSED + lane] = closed
            put_triple(located, row, FORCE, lane, fx, fy, fz)
            put_triple(located, row, MOMENT, lane, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
            packets[packet, HELD + lane] = held
            located[row, SPRUNG + lane] = held
            located[row, SLID + lane] = slid
            located[row, DAMPED + lane] = damped
        if gamma_s > 0.0:
            _add_shear_dashpots_into(packets, packet, located, row, gamma_s * law.rate, law)
        for entry in range(N_SUMS * LANES):
            lanes[entry] += located[row, FORCE + entry]
    for quantity in range(N_SUMS):
        sums[quantity] = sum_lanes(lanes, quantity * LANES)


@separate_kernel
def _add_shear_dashpots_into(packets, packet, located, row, gamma_rate, law):
    """Dashpots beside the shear springs of one packet's nodes, as long as these do not slide.

    The velocity is the mean of the step, the tangential change of place over the step, whose inverse is in
    ``gamma_rate``: of first order in the step. Spring and dashpot together stay below Coulomb's limit.
    """
    for lane in range(LANES):
        x, y, z = triple(packets, packet, PLACE, lane)
        nx, ny, nz = triple(located, row, NORMAL, lane)
        mx, my, mz = triple(located, row, MOVED, lane)
        phi, along = located[row, PHI + lane], packets[packet, CLOSED + lane]
        ux, uy, uz = mx - along * nx, my - along * ny, mz - along * nz
        # a node sticks where this step made no friction heat
        sticks = phi < 0.0 and located[row, SLID + lane] == 0.0
        c = gamma_rate * packets[packet, DAMPING_WEIGHT + lane] if sticks else 0.0
        gx, gy, gz = triple(located, row, FORCE, lane)
        f_n = gx * nx + gy * ny + gz * nz
        gx, gy, gz = gx - f_n * nx, gy - f_n * ny, gz - f_n * nz
        # the share of it that Coulomb's limit leaves: |g - share c u| = mu f_n
        square = c * c * (ux * ux + uy * uy + uz * uz)
        along_u = -c * (gx * ux + gy * uy + gz * uz)
        room = law.mu * law.mu * f_n * f_n - (gx * gx + gy * gy + gz * gz)
        root = np.sqrt(max(along_u * along_u + square * max(room, 0.0), 0.0))
        share = (root - along_u) / square if square > 0.0 else 0.0
        c *= min(max(share, 0.0), 1.0)
        fx, fy, fz = -c * ux, -c * uy, -c * uz
        add_triple(located, row, FORCE, lane, fx, fy, fz)
        add_triple(located, row, MOMENT, lane, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
        located[row, DAMPED + lane] += c * (ux * ux + uy * uy + uz * uz)
