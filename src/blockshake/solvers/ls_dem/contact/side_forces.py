"""Forces of the located nodes of one side of a pair of bodies: the law at each, and their sum, Eq. (6)."""

import numpy as np

from blockshake.jit import borrowing_kernel
from blockshake.solvers.ls_dem.contact.contact_law import node_force
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BUSY,
    CLOSED,
    DAMPED,
    DAMPING_WEIGHT,
    FORCE_X,
    FORCE_Y,
    FORCE_Z,
    HELD,
    LANES,
    MOMENT_X,
    MOMENT_Y,
    MOMENT_Z,
    MOVED_X,
    MOVED_Y,
    MOVED_Z,
    N_SUMS,
    NORMAL_X,
    NORMAL_Y,
    NORMAL_Z,
    PHI,
    PLACE_X,
    PLACE_Y,
    PLACE_Z,
    SLID,
    SLOPE,
    STRETCH_X,
    STRETCH_Y,
    STRETCH_Z,
    sum_lanes,
)


@borrowing_kernel
def side_forces_into(packets, first, last, law, gamma_s, lanes, sums):
    """Forces of the nodes of one side, summed.

    Parameters
    ----------
    packets : float64 array, shape (n_packets, PACKET)
        Located nodes; their springs are updated.
    first, last : int
        Packets of this side.
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
        if packets[packet, BUSY] == 0.0:
            for lane in range(LANES):
                packets[packet, CLOSED + lane] = (
                    packets[packet, MOVED_X + lane] * packets[packet, NORMAL_X + lane]
                    + packets[packet, MOVED_Y + lane] * packets[packet, NORMAL_Y + lane]
                    + packets[packet, MOVED_Z + lane] * packets[packet, NORMAL_Z + lane]
                )
            continue
        for lane in range(LANES):
            fx, fy, fz, sx, sy, sz, closed, held, slid, damped = node_force(
                packets[packet, PHI + lane], packets[packet, SLOPE + lane], packets[packet, NORMAL_X + lane],
                packets[packet, NORMAL_Y + lane], packets[packet, NORMAL_Z + lane], packets[packet, MOVED_X + lane],
                packets[packet, MOVED_Y + lane], packets[packet, MOVED_Z + lane], packets[packet, STRETCH_X + lane],
                packets[packet, STRETCH_Y + lane], packets[packet, STRETCH_Z + lane], packets[packet, CLOSED + lane],
                packets[packet, AREA + lane], packets[packet, DAMPING_WEIGHT + lane], law,
            )  # fmt: skip
            x, y = packets[packet, PLACE_X + lane], packets[packet, PLACE_Y + lane]
            z = packets[packet, PLACE_Z + lane]
            packets[packet, STRETCH_X + lane] = sx
            packets[packet, STRETCH_Y + lane] = sy
            packets[packet, STRETCH_Z + lane] = sz
            packets[packet, CLOSED + lane] = closed
            packets[packet, FORCE_X + lane] = fx
            packets[packet, FORCE_Y + lane] = fy
            packets[packet, FORCE_Z + lane] = fz
            packets[packet, MOMENT_X + lane] = y * fz - z * fy
            packets[packet, MOMENT_Y + lane] = z * fx - x * fz
            packets[packet, MOMENT_Z + lane] = x * fy - y * fx
            packets[packet, HELD + lane] = held
            packets[packet, SLID + lane] = slid
            packets[packet, DAMPED + lane] = damped
        if gamma_s > 0.0:
            _add_shear_dashpots_into(packets, packet, gamma_s * law.rate, law)
        for entry in range(N_SUMS * LANES):
            lanes[entry] += packets[packet, FORCE_X + entry]
    for quantity in range(N_SUMS):
        sums[quantity] = sum_lanes(lanes, quantity * LANES)


@borrowing_kernel
def _add_shear_dashpots_into(packets, packet, gamma_rate, law):
    """Dashpots beside the shear springs of one packet's nodes, as long as these do not slide.

    The velocity is the mean of the step, the tangential change of place over the step, whose inverse is in
    ``gamma_rate``: of first order in the step. Spring and dashpot together stay below Coulomb's limit.
    """
    for lane in range(LANES):
        x, y = packets[packet, PLACE_X + lane], packets[packet, PLACE_Y + lane]
        z, phi = packets[packet, PLACE_Z + lane], packets[packet, PHI + lane]
        nx, ny = packets[packet, NORMAL_X + lane], packets[packet, NORMAL_Y + lane]
        nz, along = packets[packet, NORMAL_Z + lane], packets[packet, CLOSED + lane]
        ux = packets[packet, MOVED_X + lane] - along * nx
        uy = packets[packet, MOVED_Y + lane] - along * ny
        uz = packets[packet, MOVED_Z + lane] - along * nz
        # a node sticks where this step made no friction heat
        sticks = phi < 0.0 and packets[packet, SLID + lane] == 0.0
        c = gamma_rate * packets[packet, DAMPING_WEIGHT + lane] if sticks else 0.0
        gx, gy = packets[packet, FORCE_X + lane], packets[packet, FORCE_Y + lane]
        gz = packets[packet, FORCE_Z + lane]
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
        packets[packet, FORCE_X + lane] += fx
        packets[packet, FORCE_Y + lane] += fy
        packets[packet, FORCE_Z + lane] += fz
        packets[packet, MOMENT_X + lane] += y * fz - z * fy
        packets[packet, MOMENT_Y + lane] += z * fx - x * fz
        packets[packet, MOMENT_Z + lane] += x * fy - y * fx
        packets[packet, DAMPED + lane] += c * (ux * ux + uy * uy + uz * uz)
