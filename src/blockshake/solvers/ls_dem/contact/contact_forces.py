"""Contact of pairs of bodies: both checked against each other, forces gathered on bodies and joints."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.friction import friction_asymmetry, friction_coefficient
from blockshake.geometry.vectors import cross, difference, matrix_product
from blockshake.jit import inner_kernel, kernel_without_allocation, loop_kernel
from blockshake.solvers.ls_dem.contact.candidates import locate_pair_into, sleeps, span_of
from blockshake.solvers.ls_dem.contact.contact_law import Law, side_forces_into
from blockshake.solvers.ls_dem.contact.packets import (
    LANES,
    N_SUMS,
    SUM_DAMPED,
    SUM_HELD,
    SUM_SLID,
    cache_lines,
)
from blockshake.solvers.ls_dem.interfaces import dashpot_coefficient, in_series, normal_stiffness
from blockshake.solvers.ls_dem.progress import NearPairs

# Entries of ``Loads.energy`` [J]: what springs hold, what friction and dashpots turned into heat in the step, and the
# work of external forces in it
SPRING_ENERGY, STEP_FRICTION_HEAT, STEP_DASHPOT_HEAT, STEP_EXTERNAL_WORK, N_ENERGIES = 0, 1, 2, 3, 4
# s, of the slip rate's delay; the time step of the nonsmooth solver, which has one of its own
_RATE_TIME = 1e-3


class Loads(NamedTuple):
    """Result of a force evaluation, overwritten by it.

    ``force``, ``moment`` (n_bodies, 3) on each body [N, N m], world frame, about its mass centre;
    ``energy`` (N_ENERGIES,) [J]; ``joints``: forces and slips of the pairs. Workspace of one pair: ``R`` (3, 3) and
    ``d`` (2, 3), see `relative_pose_into`; ``lanes`` (N_SUMS * LANES,) and ``sums`` (N_SUMS,), see `side_forces_into`.
    """

    force: np.ndarray
    moment: np.ndarray
    energy: np.ndarray
    joints: NearPairs
    R: np.ndarray
    d: np.ndarray
    lanes: np.ndarray
    sums: np.ndarray


@inner_kernel
def no_loads(n_bodies, joints):
    """Loads before the first evaluation."""
    return Loads(
        np.zeros((n_bodies, 3)), np.zeros((n_bodies, 3)), np.zeros(N_ENERGIES), joints, np.empty((3, 3)),
        np.empty((2, 3)), cache_lines(1, N_SUMS * LANES)[0], np.empty(N_SUMS),
    )  # fmt: skip


@kernel_without_allocation
def clear_loads(bodies, loads):
    """Start a force evaluation: gravity on every free body, nothing else."""
    loads.moment[:] = 0.0
    loads.energy[:] = 0.0
    loads.joints.force[:] = 0.0
    for body in range(bodies.mass.size):
        for axis in range(3):
            loads.force[body, axis] = 0.0 if bodies.driven[body] else bodies.mass[body] * bodies.gravity[axis]


@loop_kernel
def forces_into(bodies, candidates, surfaces, interfaces, poses, dt, loads):
    """Gravity and contact forces, see `contact_forces_into`, as Python calls them."""
    clear_loads(bodies, loads)
    contact_forces_into(candidates, surfaces, interfaces, poses, dt, loads)


@kernel_without_allocation
def contact_forces_into(candidates, surfaces, interfaces, poses, dt, loads):
    """Contact forces between all near pairs, added to ``loads``, with force and slip of the joints.

    Places and shear springs of the candidates are updated. ``dt``: time since the step before, zero at the first [s].

    Notes
    -----
    Each body's nodes are checked against the other's level set; each side carries half of the interface's stiffness, so
    that a face on a face has it once. Of a body on a wide driven box the body's own nodes carry all. The area in touch
    is the mean of what the two sides find.
    """
    R, d, lanes, sums = loads.R, loads.d, loads.lanes, loads.sums
    pairs, bounds = candidates.pairs, candidates.first
    offset, rotation = surfaces.offset, poses.rotation
    force, moment, joint_force = loads.force, loads.moment, loads.joints.force
    energy = loads.energy
    rate = 1.0 / dt if dt > 0.0 else 0.0
    for pair in range(pairs.shape[0]):
        if bounds[2 * pair] == bounds[2 * pair + 2]:
            continue
        a, b, joint = pairs[pair, 0], pairs[pair, 1], candidates.joint[pair]
        # a pair so far apart that no node of it can touch yet costs nothing but this
        if sleeps(candidates, poses.position, pair):
            _slip_into(loads.joints, joint, 0.0, 0.0, dt)
            continue
        area = locate_pair_into(candidates, surfaces, poses, pair, R, d)
        k_n, k_s = normal_stiffness(interfaces, a, b), in_series(interfaces.k_s, a, b)
        gamma_n = dashpot_coefficient(interfaces, a, b, interfaces.damping_ratio, k_n, area)
        gamma_s = dashpot_coefficient(interfaces, a, b, interfaces.shear_damping_ratio, k_s, area)
        # friction by the joint's slip of the step before: explicit, so that no node waits for another
        slip_rate, slip = loads.joints.slip_rate[joint], loads.joints.slip[joint]
        mu = friction_coefficient(interfaces.friction, a, b, slip_rate, slip)
        bias = mu * friction_asymmetry(interfaces.friction, a, b)
        heat = 0.0
        for side in range(2):
            # along the first body's x in the other's frame; its own slip is the reverse of the second's
            bx, by, bz = (
                (bias, 0.0, 0.0) if side == 1 else (-bias * R[0, 0], -bias * R[0, 1], -bias * R[0, 2])
            )
            # each side carries half of the stiffness: a face on a face has the whole
            law = Law(0.5 * k_n, 0.5 * k_s, gamma_n, mu, bx, by, bz, interfaces.least_force, rate)
            side_forces_into(candidates.packets, span_of(candidates, pair, side), law, gamma_s, lanes, sums)
            _share_into(
                pairs[pair, side], pairs[pair, 1 - side], side, rotation, offset, d, sums, force, moment, joint,
                joint_force,
            )  # fmt: skip
            heat += sums[SUM_SLID]
            energy[STEP_DASHPOT_HEAT] += sums[SUM_DAMPED]
            energy[SPRING_ENERGY] += sums[SUM_HELD]
        _lever_into(candidates.shift[pair], rotation[b], joint_force[joint], moment[b])
        energy[STEP_FRICTION_HEAT] += heat
        _slip_into(loads.joints, joint, mu, heat, dt)


@kernel_without_allocation
def _share_into(owner, other, side, rotation, offset, d, sums, force, moment, joint, joint_force):
    """Add the summed force of a side to both bodies and to the joint, whose second body owns side 1."""
    sign = 1.0 if side == 1 else -1.0
    f, m = (sums[0], sums[1], sums[2]), (sums[3], sums[4], sums[5])
    # moments about both mass centres: the owner's is at d from the centroid of the other's shape, the other's at e
    of_owner = matrix_product(rotation[other], difference(m, cross(d[side], f)))
    of_other = matrix_product(rotation[other], difference(m, cross(offset[other], f)))
    f = matrix_product(rotation[other], f)
    for i in range(3):
        force[owner, i] += f[i]
        force[other, i] -= f[i]
        moment[owner, i] += of_owner[i]
        moment[other, i] -= of_other[i]
        joint_force[joint, i] += sign * f[i]


@kernel_without_allocation
def _lever_into(shift, rotation, force, moment):
    """Moment of the force on a pair's second body about where it is, not about where contact sees it."""
    lever = cross(matrix_product(rotation, shift), force)
    for i in range(3):
        moment[i] -= lever[i]


@kernel_without_allocation
def _slip_into(joints, joint, mu, heat, dt):
    """Slip of a joint in this step: its friction heat over Coulomb's limit, a mean weighted by the force.

    Its rate follows with a delay of `_RATE_TIME`: taken step by step, it is that of springs without mass, and a
    coefficient that falls with it would jump up and down the more, the smaller the step.
    """
    fx, fy, fz = joints.force[joint, 0], joints.force[joint, 1], joints.force[joint, 2]
    squared = fx * fx + fy * fy + fz * fz
    if squared > 0.0:
        joints.touched[joint] = True
    slip = 0.0
    if heat > 0.0:
        # of a contact that slides as a whole, the part of the force that is friction
        limit = mu * np.sqrt(squared / (1.0 + mu * mu))
        slip = heat / limit if limit > 0.0 else 0.0
    joints.slip[joint] += slip
    if dt > 0.0:
        joints.slip_rate[joint] += (slip / dt - joints.slip_rate[joint]) * dt / (_RATE_TIME + dt)
