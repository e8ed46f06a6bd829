"""The contact law of a node, Eqs. (2), (4) and (5) of Zhou et al. (2023), and the sum of a side's nodes, Eq. (6)."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import kernel_without_aliasing, kernel_without_allocation
from blockshake.solvers.ls_dem.contact.located_nodes import moved
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    BEFORE,
    BUSY,
    BUSY_BEFORE,
    CLOSED,
    DAMPED,
    DAMPING_WEIGHT,
    FACTOR,
    FORCE,
    IDLE,
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
    STRAINED,
    STRETCH,
    add_triple,
    put_triple,
    sum_lanes,
    triple,
)


class Law(NamedTuple):
    """Contact law of the nodes of one side.

    ``k_n``, ``k_s``: stiffness per area of node [N/m3]; ``gamma_n``: dashpot, per unit of a node's
    damping weight; ``mu``: Coulomb's coefficient, and ``bias_x, bias_y, bias_z`` its change by direction: it is
    ``mu + bias . s`` for the unit vector s of the owner's slip, other's frame; ``least_force``: the cut of
    Eq. (2) [N]; ``rate``: the inverse of the time since the step before, zero at the first step [1/s].
    """

    k_n: float
    k_s: float
    gamma_n: float
    mu: float
    bias_x: float
    bias_y: float
    bias_z: float
    least_force: float
    rate: float


@kernel_without_allocation
def normal_force(phi, slope, closing, k_n, gamma_n, least):
    """Magnitude of a node's normal force, Eq. (2) [N].

    ``phi`` is the level-set value (negative inside) [m], ``slope`` the length of its gradient: the spring's force
    is that of the energy ``k_n phi^2 / 2``, which a sampled level set keeps only so where it rounds an edge.
    ``closing`` is the velocity of the node along the outward normal of the other body [m/s], negative when
    approaching; ``k_n`` [N/m] and ``gamma_n`` [N s/m] are the node's. The damped force is cut at ``least``: at zero
    because concrete does not stick to concrete, so that a ``gamma_n`` made for a restitution of 0.50
    rebounds at 0.55; at -inf it may pull, as printed.
    """
    force = -k_n * phi * slope - gamma_n * closing
    return force if (force > least and phi < 0.0) else 0.0


@kernel_without_allocation
def trial_stretch(ox, oy, oz, ux, uy, uz, nx, ny, nz):
    """Stretch of a node's shear spring after the motion of a step, before Coulomb's limit: Eq. (4).

    ``ox, oy, oz``: stretch before [m]; ``ux, uy, uz``: change of the node's place in the step, Eq. (4)'s relative
    velocity times the step [m]; ``nx, ny, nz``: outward normal now; all in the other's frame. The stretch now, across
    the normal, is returned, whose shear force would be ``-k_s`` times it; then the part of the stretch before that lies
    along a normal that has changed, and the change of place along the normal [m].
    """
    dropped = ox * nx + oy * ny + oz * nz
    tx, ty, tz = ox + ux, oy + uy, oz + uz
    along = tx * nx + ty * ny + tz * nz
    return tx - along * nx, ty - along * ny, tz - along * nz, dropped, along - dropped


@kernel_without_allocation
def kept_stretch(tx, ty, tz, f_n, k_s, law):
    """Share of a trial stretch that Coulomb's limit lets a shear spring keep, Eq. (5), and the stretch squared.

    ``tx, ty, tz`` [m]; ``f_n`` the normal force, not below zero [N]; ``k_s`` of the node [N/m]. A node out
    of contact has no limit force and lets go.
    """
    squared = tx * tx + ty * ty + tz * tz
    limit = f_n * (law.mu * np.sqrt(squared) + law.bias_x * tx + law.bias_y * ty + law.bias_z * tz)
    reach = k_s * squared
    return limit / reach if reach > limit else 1.0, squared


@kernel_without_allocation
def node_force(phi, slope, nx, ny, nz, ux, uy, uz, ox, oy, oz, closed, area, weight, law):
    """Force of one node, its springs afterwards, and the energy it moved.

    Parameters
    ----------
    phi, slope, nx, ny, nz : float
        Level-set value [m], length of its gradient [1] and outward normal of the other body there.
    ux, uy, uz, ox, oy, oz : float
        Change of place since the step before, and stretch of the shear spring so far, other's frame [m].
    closed : float
        Change of place along the normal in the step before [m].
    area, weight, law : float, float, Law
        Area of the node [m2]; factor of its dashpot.

    Returns
    -------
    fx, fy, fz, sx, sy, sz, closed : float
        Force on the owner, other's frame [N]; stretch and change along the normal now [m].
    held, slid, damped : float
        Energy that the springs hold, friction heat and dashpot heat of the step [J].

    Notes
    -----
    The stretch is kept in the frame of the body whose level set is read, so that it turns with the interface; where the
    normal changes (from a flat to a chamfer) its part along the new normal is dropped, and what the spring held of it
    counts as dashpot heat. The velocity of the dashpot is that of the last two half steps carried on to the step, which
    is of second order. Friction heat is the mean shear force of the step times the slip: exactly the work on the spring
    less the energy it gained.
    """
    k_node, k_shear = law.k_n * area, law.k_s * area
    tx, ty, tz, dropped, now_closed = trial_stretch(ox, oy, oz, ux, uy, uz, nx, ny, nz)
    moved = 1.5 * now_closed - 0.5 * closed
    f_n = normal_force(phi, slope, moved * law.rate, k_node, law.gamma_n * weight, law.least_force)
    kept, squared = kept_stretch(tx, ty, tz, max(f_n, 0.0), k_shear, law)
    sx, sy, sz = kept * tx, kept * ty, kept * tz

    # slip is the trial stretch less what was kept of it
    depth = -phi if phi < 0.0 else 0.0
    spring, half = k_node * depth * slope, 0.5 * k_shear
    after = kept * squared
    held = half * kept * after + 0.5 * k_node * depth * depth
    slid = half * (1.0 - kept) * (ox * tx + oy * ty + oz * tz + after)
    damped = half * dropped * dropped - (f_n - spring) * moved
    fx, fy, fz = f_n * nx - k_shear * sx, f_n * ny - k_shear * sy, f_n * nz - k_shear * sz
    return fx, fy, fz, sx, sy, sz, now_closed, held, slid, damped


@kernel_without_aliasing
def side_forces_into(packets, span, law, gamma_s, lanes, sums):
    """Forces of the nodes of one side, summed.

    Parameters
    ----------
    packets, span
        As in `locate_nodes_into`: the nodes' springs are updated, their forces overwritten.
    law, gamma_s : Law, float
        Dashpot next to the shear springs, per unit of a node's damping weight.
    lanes, sums : float64 arrays, shape (N_SUMS * LANES,) and (N_SUMS,)
        Workspace; overwritten with force and moment about the centroid of the other's shape, on the owner, other's
        frame [N, N m], friction heat and dashpot heat of this step, and elastic energy held [J].

    Notes
    -----
    A packet that is idle has no force.
    """
    lanes[:] = 0.0
    located, kept = packets.located, packets.kept
    for packet in range(span.first, span.last):
        row, alike = packet - span.start, packet - span.first + span.alike
        if located[row, BUSY] == 0.0:
            packets.state[packet] = IDLE
            continue
        strained = False
        for lane in range(LANES):
            nx, ny, nz = triple(located, row, NORMAL, lane)
            ux, uy, uz = moved(packets, packet, row, lane)
            ox, oy, oz = triple(kept, packet, STRETCH, lane)
            factor = kept[packet, FACTOR + lane]
            fx, fy, fz, sx, sy, sz, closed, held, slid, damped = node_force(
                located[row, PHI + lane], located[row, SLOPE + lane], nx, ny, nz, ux, uy, uz, ox, oy, oz,
                kept[packet, CLOSED + lane], factor * packets.alike[alike, AREA + lane],
                factor * packets.alike[alike, DAMPING_WEIGHT + lane], law,
            )  # fmt: skip
            x, y, z = triple(located, row, PLACE, lane)
            put_triple(located, row, MOVED, lane, ux, uy, uz)
            put_triple(kept, packet, BEFORE, lane, x, y, z)
            put_triple(kept, packet, STRETCH, lane, sx, sy, sz)
            kept[packet, CLOSED + lane] = closed
            put_triple(located, row, FORCE, lane, fx, fy, fz)
            put_triple(located, row, MOMENT, lane, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
            strained |= held != 0.0
            located[row, SPRUNG + lane] = held
            located[row, SLID + lane] = slid
            located[row, DAMPED + lane] = damped
        packets.state[packet] = STRAINED if strained else BUSY_BEFORE
        if gamma_s > 0.0:
            _add_shear_dashpots_into(packets, packet, alike, row, gamma_s * law.rate, law)
        for entry in range(N_SUMS * LANES):
            lanes[entry] += located[row, FORCE + entry]
    for quantity in range(N_SUMS):
        sums[quantity] = sum_lanes(lanes, quantity * LANES)


@kernel_without_aliasing
def _add_shear_dashpots_into(packets, packet, alike, row, gamma_rate, law):
    """Dashpots next to the shear springs of one packet's nodes, as long as these do not slide.

    The velocity is the mean of the step, the tangential change of place over the step, whose inverse is in
    ``gamma_rate``: of first order in the step. Spring and dashpot together stay below Coulomb's limit.
    """
    located, kept = packets.located, packets.kept
    for lane in range(LANES):
        x, y, z = triple(located, row, PLACE, lane)
        nx, ny, nz = triple(located, row, NORMAL, lane)
        mx, my, mz = triple(located, row, MOVED, lane)
        phi, along = located[row, PHI + lane], kept[packet, CLOSED + lane]
        ux, uy, uz = mx - along * nx, my - along * ny, mz - along * nz
        # a node sticks where this step made no friction heat
        sticks = phi < 0.0 and located[row, SLID + lane] == 0.0
        weight = kept[packet, FACTOR + lane] * packets.alike[alike, DAMPING_WEIGHT + lane]
        c = gamma_rate * weight if sticks else 0.0
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
