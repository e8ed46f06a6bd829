"""Contact of two bodies: Eqs. (2) to (6) at every near node, both bodies checked against each other."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.level_set import box_distance
from blockshake.jit import inline_kernel, kernel
from blockshake.solvers.ls_dem.candidates import (
    AREA,
    LANES,
    PACKET,
    PHI,
    PX,
    PY,
    PZ,
    RESULT,
    SHEAR_X,
    SHEAR_Y,
    SHEAR_Z,
)
from blockshake.solvers.ls_dem.relative_motion import relative_frame_into

# Entries of the energy bookkeeping of one step [J]
ELASTIC, FRICTION, DAMPING, N_ENERGIES = 0, 1, 2, 3


class Interfaces(NamedTuple):
    """Contact parameters by pair of bodies.

    ``k_n``, ``k_s`` (n_bodies, n_bodies): stiffness per area [N/m3]; ``mu``: Coulomb's
    coefficient [1]; ``mass``: effective mass [kg]; ``damping_ratio``: of Eq. (3) [1].
    """

    k_n: np.ndarray
    k_s: np.ndarray
    mu: np.ndarray
    mass: np.ndarray
    damping_ratio: float


class Loads(NamedTuple):
    """Result of a force evaluation, overwritten by it.

    ``force``, ``moment`` (n_bodies, 3) on each body [N, N m], world frame, about its mass centre;
    ``joint`` (n_bodies, n_bodies) int64: row of `joint_force` of a pair, -1 before it touched;
    ``joint_force`` (n_joints_max, 3) on the second body [N]; ``energy`` (3,) [J].
    """

    force: np.ndarray
    moment: np.ndarray
    joint: np.ndarray
    joint_force: np.ndarray
    energy: np.ndarray


def damping_ratio(restitution):
    """Fraction of critical damping of Eq. (3) for a coefficient of restitution.

    Zhou et al. (2023), Eq. (3) after Tsuji et al. (1993), with ``ln C_res^2`` read as
    ``(ln C_res)^2``: a spring and dashpot that may pull then rebounds with exactly ``C_res``.
    ``C_res = 0`` means critical damping.
    """
    if restitution == 0.0:
        return 1.0
    return -np.log(restitution) / np.sqrt(np.pi**2 + np.log(restitution) ** 2)


@inline_kernel
def normal_force(phi, closing, k_n, gamma_n):
    """Magnitude of a node's normal force, Eq. (2), never pulling [N].

    ``phi`` is the level-set value (negative inside) [m], ``closing`` the velocity of the node
    along the outward normal of the other body [m/s], negative when approaching. The damped force
    is cut at zero because concrete does not stick to concrete; so a ``gamma_n`` made for a
    restitution of 0.50 rebounds at 0.55.
    """
    force = -k_n * phi - gamma_n * closing
    return force if (force > 0.0 and phi < 0.0) else 0.0


@kernel
def _touching_area(packets, first, last, R, frame, side, half, chamfer, shape):
    """Area of the listed nodes that lie inside the other body [m2]."""
    a, b, c, leg = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape]
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = (
        R[side, 0, 0], R[side, 0, 1], R[side, 0, 2], R[side, 1, 0], R[side, 1, 1], R[side, 1, 2],
        R[side, 2, 0], R[side, 2, 1], R[side, 2, 2],
    )  # fmt: skip
    d0, d1, d2 = frame[side, 0, 0], frame[side, 0, 1], frame[side, 0, 2]
    area = 0.0
    for packet in range(first, last):
        nodes = packets[packet * PACKET : (packet + 1) * PACKET]
        for lane in range(LANES):
            x, y, z = nodes[PX + lane], nodes[PY + lane], nodes[PZ + lane]
            phi, _, _, _ = box_distance(
                r00 * x + r01 * y + r02 * z + d0,
                r10 * x + r11 * y + r12 * z + d1,
                r20 * x + r21 * y + r22 * z + d2,
                a, b, c, leg,
            )  # fmt: skip
            nodes[RESULT + lane] = nodes[AREA + lane] if phi < 0.0 else 0.0
        area += _sum_lanes(nodes, RESULT)
    return area


@inline_kernel
def _sum_lanes(nodes, row):
    """Sum of a packet's row, in a fixed order."""
    return ((nodes[row] + nodes[row + 1]) + (nodes[row + 2] + nodes[row + 3])) + (
        (nodes[row + 4] + nodes[row + 5]) + (nodes[row + 6] + nodes[row + 7])
    )


@kernel
def _side_forces_into(packets, first, last, R, frame, side, half, chamfer, shape, law, total):
    """Forces of the nodes of one side, summed.

    Parameters
    ----------
    packets : float64 array, shape (n_packets * PACKET,)
        As in `Candidates`; shear forces and level-set values are updated.
    first, last : int
        Packets of this side.
    R, frame, side : float64 arrays, shape (2, 3, 3) and (2, 7, 3), int
        From `relative_frame_into`.
    half, chamfer, shape : as in `Surfaces`, int
        Of the body whose level set is read [m].
    law : tuple of 5 floats
        ``k_n``, ``k_s``, ``gamma_n`` per area of node [N/m3, N/m3, N s/m3], Coulomb's ``mu`` [1]
        and the time ``dt`` for which the dashpot heats [s].
    total : float64 array, shape (9,)
        Overwritten: force and moment about the other body's mass centre, on the owner, other's
        frame [N, N m]; elastic energy held, friction heat and dashpot heat of this step [J].

    Notes
    -----
    Zhou et al. (2023), Eqs. (2), (4), (5) and (6). The shear force is kept in the frame of the
    body whose level set is read, so that it turns with the interface; where the normal changes
    (from a flat to a chamfer) its part along the new normal is dropped, and what the spring held
    of it counts as dashpot heat. Friction heat is the mean shear force of the step times the
    slip: exactly the work on the spring less the energy it gained.
    """
    a, b, c, leg = half[shape, 0], half[shape, 1], half[shape, 2], chamfer[shape]
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = (
        R[side, 0, 0], R[side, 0, 1], R[side, 0, 2], R[side, 1, 0], R[side, 1, 1], R[side, 1, 2],
        R[side, 2, 0], R[side, 2, 1], R[side, 2, 2],
    )  # fmt: skip
    d0, d1, d2 = frame[side, 0, 0], frame[side, 0, 1], frame[side, 0, 2]
    v0, v1, v2 = frame[side, 1, 0], frame[side, 1, 1], frame[side, 1, 2]
    w0, w1, w2 = frame[side, 2, 0], frame[side, 2, 1], frame[side, 2, 2]
    m0, m1, m2 = frame[side, 3, 0], frame[side, 3, 1], frame[side, 3, 2]
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = (
        frame[side, 4, 0], frame[side, 4, 1], frame[side, 4, 2], frame[side, 5, 0], frame[side, 5, 1],
        frame[side, 5, 2], frame[side, 6, 0], frame[side, 6, 1], frame[side, 6, 2],
    )  # fmt: skip
    k_n, k_s, gamma_n, mu, dt = law
    total[:] = 0.0
    for packet in range(first, last):
        nodes = packets[packet * PACKET : (packet + 1) * PACKET]
        for lane in range(LANES):
            px, py, pz, area = nodes[PX + lane], nodes[PY + lane], nodes[PZ + lane], nodes[AREA + lane]
            x = r00 * px + r01 * py + r02 * pz + d0
            y = r10 * px + r11 * py + r12 * pz + d1
            z = r20 * px + r21 * py + r22 * pz + d2
            phi, nx, ny, nz = box_distance(x, y, z, a, b, c, leg)

            k_node, k_shear = k_n * area, k_s * area
            softness = 1.0 / k_shear
            closing = nx * (v0 + w1 * z - w2 * y) + ny * (v1 + w2 * x - w0 * z) + nz * (v2 + w0 * y - w1 * x)
            f_n = normal_force(phi, closing, k_node, gamma_n * area)

            # Eq. (4): the spring follows the tangential part of the motion since the last step
            ux = m00 * px + m01 * py + m02 * pz + m0
            uy = m10 * px + m11 * py + m12 * pz + m1
            uz = m20 * px + m21 * py + m22 * pz + m2
            along = ux * nx + uy * ny + uz * nz
            ux, uy, uz = ux - along * nx, uy - along * ny, uz - along * nz
            ox, oy, oz = nodes[SHEAR_X + lane], nodes[SHEAR_Y + lane], nodes[SHEAR_Z + lane]
            lost = ox * nx + oy * ny + oz * nz
            ox, oy, oz = ox - lost * nx, oy - lost * ny, oz - lost * nz
            qx, qy, qz = ox - k_shear * ux, oy - k_shear * uy, oz - k_shear * uz

            # Eq. (5): Coulomb's limit; a node out of contact has none and lets go
            trial = np.sqrt(qx * qx + qy * qy + qz * qz)
            limit = mu * f_n
            kept = limit / trial if trial > limit else 1.0
            qx, qy, qz = kept * qx, kept * qy, kept * qz
            nodes[SHEAR_X + lane], nodes[SHEAR_Y + lane], nodes[SHEAR_Z + lane] = qx, qy, qz
            nodes[PHI + lane] = phi

            # slip = motion less stretch; the shear force on the owner opposes it, hence the sign
            gx, gy, gz = ux + softness * (qx - ox), uy + softness * (qy - oy), uz + softness * (qz - oz)
            spring = -k_node * phi if phi < 0.0 else 0.0
            nodes[RESULT + 6 * LANES + lane] = 0.5 * (softness * (qx * qx + qy * qy + qz * qz) - spring * phi)
            nodes[RESULT + 7 * LANES + lane] = -0.5 * ((qx + ox) * gx + (qy + oy) * gy + (qz + oz) * gz)
            nodes[RESULT + 8 * LANES + lane] = 0.5 * softness * lost * lost - (f_n - spring) * closing * dt

            # Eq. (6)
            tx, ty, tz = f_n * nx + qx, f_n * ny + qy, f_n * nz + qz
            nodes[RESULT + lane] = tx
            nodes[RESULT + LANES + lane] = ty
            nodes[RESULT + 2 * LANES + lane] = tz
            nodes[RESULT + 3 * LANES + lane] = y * tz - z * ty
            nodes[RESULT + 4 * LANES + lane] = z * tx - x * tz
            nodes[RESULT + 5 * LANES + lane] = x * ty - y * tx
        for quantity in range(9):
            total[quantity] += _sum_lanes(nodes, RESULT + quantity * LANES)


@kernel
def contact_forces_into(candidates, surfaces, interfaces, kinematics, dt, loads):
    """Contact forces between all near pairs, added to ``loads``.

    Parameters
    ----------
    candidates : Candidates
        Near nodes; their shear forces are updated.
    surfaces : Surfaces
    interfaces : Interfaces
    kinematics : Kinematics
    dt : float
        Time since the step before [s].
    loads : Loads
        Force, moment, joint force and energy are added to; a pair that touches for the first
        time gets the next joint.

    Notes
    -----
    Each body's nodes are checked against the other's level set; each side carries half of the
    interface's stiffness, so that a face on a face has it once. Damping belongs to the interface:
    with the area A in touch, ``gamma_n`` per area is ``2 zeta sqrt(m k_n / A)``, Eq. (3) for the
    mass m effective in a central impact of the two bodies, however many nodes carry it.
    """
    R, frame = np.empty((2, 3, 3)), np.empty((2, 7, 3))
    turned, total = np.empty((3, 3)), np.empty(9)
    pairs, bounds, packets = candidates.pairs, candidates.first, candidates.packets
    shapes, half, chamfer = surfaces.shape, surfaces.half, surfaces.chamfer
    k_n, k_s, mu, mass = interfaces.k_n, interfaces.k_s, interfaces.mu, interfaces.mass
    energy = loads.energy
    for pair in range(pairs.shape[0]):
        if bounds[2 * pair] == bounds[2 * pair + 2]:
            continue
        a, b = pairs[pair, 0], pairs[pair, 1]
        area = 0.0
        for side in range(2):
            owner, other = (a, b) if side == 0 else (b, a)
            relative_frame_into(kinematics, owner, other, side, turned, R, frame)
            area += 0.5 * _touching_area(
                packets, bounds[2 * pair + side], bounds[2 * pair + side + 1], R, frame, side,
                half, chamfer, shapes[other],
            )  # fmt: skip
        gamma_n = interfaces.damping_ratio * np.sqrt(mass[a, b] * k_n[a, b] / area) if area > 0.0 else 0.0
        law = (0.5 * k_n[a, b], 0.5 * k_s[a, b], gamma_n, mu[a, b], dt)
        for side in range(2):
            owner, other = (a, b) if side == 0 else (b, a)
            _side_forces_into(
                packets, bounds[2 * pair + side], bounds[2 * pair + side + 1], R, frame, side,
                half, chamfer, shapes[other], law, total,
            )  # fmt: skip
            _share_into(owner, other, b, kinematics.rotation, frame, side, total, loads)
            energy[ELASTIC] += total[6]
            energy[FRICTION] += total[7]
            energy[DAMPING] += total[8]


@kernel
def _share_into(owner, other, second, rotation, frame, side, total, loads):
    """Add the summed force of a side to both bodies and to the pair's joint."""
    first = min(owner, other)
    last = max(owner, other)
    joint = loads.joint[first, last]
    if joint < 0 and total[0] * total[0] + total[1] * total[1] + total[2] * total[2] > 0.0:
        joint = loads.joint.max() + 1
        joint = joint if joint < loads.joint_force.shape[0] else -1
        loads.joint[first, last] = joint
    sign = 1.0 if owner == second else -1.0
    # moment about the owner's mass centre, d away from the other's
    d0, d1, d2 = frame[side, 0, 0], frame[side, 0, 1], frame[side, 0, 2]
    f0, f1, f2 = total[0], total[1], total[2]
    m0, m1, m2 = total[3], total[4], total[5]
    o0, o1, o2 = m0 - (d1 * f2 - d2 * f1), m1 - (d2 * f0 - d0 * f2), m2 - (d0 * f1 - d1 * f0)
    force, moment, joint_force = loads.force, loads.moment, loads.joint_force
    for i in range(3):
        e0, e1, e2 = rotation[other, i, 0], rotation[other, i, 1], rotation[other, i, 2]
        f = e0 * f0 + e1 * f1 + e2 * f2
        force[owner, i] += f
        force[other, i] -= f
        moment[owner, i] += e0 * o0 + e1 * o1 + e2 * o2
        moment[other, i] -= e0 * m0 + e1 * m1 + e2 * m2
        if joint >= 0:
            joint_force[joint, i] += sign * f
