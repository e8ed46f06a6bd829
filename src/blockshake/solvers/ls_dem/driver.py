"""LS-DEM from a structure and a motion to a trajectory."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import rest_table
from blockshake.dynamics.system import State, Trajectory, assemble_bodies, place_driven_into
from blockshake.errors import InputError
from blockshake.geometry.surface_nodes import box_nodes
from blockshake.solvers.ls_dem.candidates import (
    PACKET,
    PHI,
    SHEAR_X,
    Surfaces,
    empty_candidates,
    find_candidates,
)
from blockshake.solvers.ls_dem.contact import Interfaces, damping_ratio
from blockshake.solvers.ls_dem.loop import COLLAPSED, DIVERGED, Record, integrate
from blockshake.solvers.ls_dem.settle import settle


def simulate_ls_dem(structure, motion, parameters, record_times, time_step=1e-5, rotations_blocked=False):
    """Run LS-DEM.

    Parameters
    ----------
    structure : Structure
    motion : GroundMotion or None
        Of the driven bodies; None lets them rest.
    parameters : LsDemParameters
    record_times : float64 array, shape (n_times,)
        Increasing from 0 [s].
    time_step : float
        [s]
    rotations_blocked : bool
        No body turns: what the shear stiffness is calibrated with.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        A shape that is not a box.
    """
    bodies, state, stoppers = assemble_bodies(structure)
    if rotations_blocked:
        bodies = bodies._replace(inverse_inertia=np.zeros_like(bodies.inverse_inertia))
    surfaces = assemble_surfaces(structure, parameters)
    interfaces = assemble_interfaces(structure, parameters)
    ground = motion.table if motion is not None else rest_table()
    # the stack settles on the slab as the motion starts, pitch included
    at_start = np.array([0.0, 0.0, 0.0, ground.coefficients[0, 3, 0]])
    place_driven_into(bodies, at_start, np.zeros(4), state)
    candidates, settling_steps = _start(
        structure, bodies, surfaces, interfaces, parameters.skin, time_step, state
    )
    n_bodies, n_times = len(structure.mass), len(record_times)
    record = Record(
        position=np.full((n_times, n_bodies, 3), np.nan),
        orientation=np.full((n_times, n_bodies, 4), np.nan),
        velocity=np.full((n_times, n_bodies, 3), np.nan),
        angular_velocity=np.full((n_times, n_bodies, 3), np.nan),
        energy=np.full((n_times, 7), np.nan),
        joint_force=np.full((n_times, 8 * n_bodies, 3), np.nan),
    )
    n_steps = int(np.ceil(record_times[-1] / time_step - 1e-9))
    code, body, last_step, rebuilds, joint = integrate(
        bodies, surfaces, interfaces, stoppers,
        ground,
        *collapse_limits(structure),
        parameters.skin, time_step, n_steps, np.asarray(record_times, dtype=float), state, candidates, record,
    )  # fmt: skip
    status, reason = _status(code, structure, body, last_step * time_step)
    joints, joint_force = _joints(structure, joint, record.joint_force)
    return Trajectory(
        time=np.asarray(record_times, dtype=float),
        position=record.position,
        orientation=record.orientation,
        velocity=record.velocity,
        angular_velocity=record.angular_velocity,
        energy=record.energy,
        joints=joints,
        joint_force=joint_force,
        status=status,
        reason=reason,
        end_time=min(last_step * time_step, float(record_times[-1])),
        numerics={
            "time_step": time_step,
            "steps": last_step,
            "settling_steps": settling_steps,
            "list_searches": rebuilds,
        },
    )


def assemble_surfaces(structure, parameters):
    """Level sets and surface nodes of a structure's shapes."""
    names = list(structure.file.shapes)
    shapes = [structure.file.shapes[name] for name in names]
    for name, shape in zip(names, shapes, strict=True):
        if shape.box is None:
            raise InputError(
                structure.source, f"shapes.{name}.mesh", "expected a box: ls-dem does not read meshes yet"
            )
        flat = min(shape.box) - 2.0 * shape.chamfer
        if 2.0 * parameters.perimeter_inset >= flat:
            raise InputError(
                structure.source,
                f"shapes.{name}",
                f"expected flats wider than twice ls_dem.perimeter_inset, not {flat} m",
            )
    nodes = [
        box_nodes(shape.box, shape.chamfer, parameters.node_spacing, parameters.perimeter_inset)
        for shape in shapes
    ]
    for name, (_, areas) in zip(names, nodes, strict=True):
        if areas.min() <= 0.0:
            raise InputError(
                structure.source, f"shapes.{name}", "expected flats much wider than ls_dem.perimeter_inset"
            )
    return Surfaces(
        shape=np.array([names.index(body.shape) for body in structure.file.bodies]),
        half=np.array([shape.box for shape in shapes]) / 2.0,
        chamfer=np.array([shape.chamfer for shape in shapes]),
        radius=np.array([np.linalg.norm(shape.box) / 2.0 for shape in shapes]),
        first_node=np.concatenate([[0], np.cumsum([len(areas) for _, areas in nodes])]),
        points=np.vstack([points for points, _ in nodes]),
        areas=np.concatenate([areas for _, areas in nodes]),
    )


def assemble_interfaces(structure, parameters):
    """Contact parameters of every pair of bodies.

    The stiffness given holds between bodies of the reference material, that of the first body
    that is not driven. A material's own stiffness goes with its Young's (shear) modulus, and two
    sides act in series, so that like on like has the stiffness of its material.
    """
    file = structure.file
    young = np.array([file.materials[body.material].youngs_modulus for body in file.bodies])
    shear = young / (
        2.0 + 2.0 * np.array([file.materials[body.material].poisson_ratio for body in file.bodies])
    )
    reference = int(np.argmin(structure.driven))
    k_n = parameters.normal_stiffness * young / young[reference]
    k_s = parameters.shear_stiffness * shear / shear[reference]
    inverse_mass = np.where(structure.driven, 0.0, 1.0 / structure.mass)
    total = inverse_mass[:, None] + inverse_mass[None, :]
    return Interfaces(
        k_n=2.0 / (1.0 / k_n[:, None] + 1.0 / k_n[None, :]),
        k_s=2.0 / (1.0 / k_s[:, None] + 1.0 / k_s[None, :]),
        mu=np.nan_to_num(structure.friction),
        mass=np.divide(1.0, total, out=np.zeros_like(total), where=total > 0.0),
        damping_ratio=float(damping_ratio(file.restitution)),
    )


def _start(structure, bodies, surfaces, interfaces, skin, time_step, state):
    """Near nodes at the start; the poses of stacks at rest are moved to their equilibrium."""
    relaxed = State(*(part.copy() for part in state))
    lists = find_candidates(
        surfaces, bodies.driven, state.position, state.orientation, skin, empty_candidates(len(bodies.mass))
    )
    settled, left, steps = settle(bodies, surfaces, interfaces, skin, time_step, relaxed, lists)
    free = ~structure.driven
    _, group = connected_components(structure.touching & free[:, None] & free[None, :])
    at_rest = free & ~np.isin(group, group[left])
    state.position[at_rest] = relaxed.position[at_rest]
    state.orientation[at_rest] = relaxed.orientation[at_rest]
    for pair, (a, b) in enumerate(settled.pairs):
        if not (at_rest[a] or at_rest[b]):
            packets = settled.packets[settled.first[2 * pair] * PACKET : settled.first[2 * pair + 2] * PACKET]
            packets.reshape(-1, PACKET)[:, SHEAR_X:PHI] = 0.0
    return settled, steps


def _status(code, structure, body, time):
    if code == COLLAPSED:
        return "collapsed", f"{structure.body_names[body]} fell or overturned by {time:.3f} s"
    if code == DIVERGED:
        return "diverged", f"a velocity grew beyond 1000 m/s or was no number at {time:.6f} s"
    return "completed", ""


def _joints(structure, joint, force):
    """Pairs that touched, lower body first, ordered by index, with the force on the upper one."""
    pairs = np.argwhere(joint >= 0)
    rows = joint[tuple(pairs.T)]
    height = structure.position[:, 2]
    swapped = height[pairs[:, 0]] > height[pairs[:, 1]]
    joints = np.where(swapped[:, None], pairs[:, ::-1], pairs)
    return joints, force[:, rows] * np.where(swapped, -1.0, 1.0)[None, :, None]
