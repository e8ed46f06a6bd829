"""LS-DEM from a structure and a motion to a trajectory."""

import logging
from pathlib import Path

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import rest_table
from blockshake.dynamics.system import Trajectory, assemble_bodies, place_driven_into
from blockshake.errors import InputError
from blockshake.geometry.structure import DEEPEST_OVERLAP
from blockshake.solvers.checkpoint import NEWS, Due, run_key
from blockshake.solvers.ls_dem.candidates import empty_candidates
from blockshake.solvers.ls_dem.checkpoint import load_checkpoint, save_checkpoint
from blockshake.solvers.ls_dem.equilibrium import approach_equilibrium
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.joints import no_joints
from blockshake.solvers.ls_dem.loop import COLLAPSED, DIVERGED, PAUSED, integrate
from blockshake.solvers.ls_dem.packets import FORCE_X, NORMAL_X, PHI, STRETCH_X
from blockshake.solvers.ls_dem.progress import NEXT_RECORD, SEARCHES, STEP, start_progress
from blockshake.solvers.ls_dem.settle import settle
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces
from blockshake.solvers.record import empty_record, with_room

_log = logging.getLogger(__name__)
_PAUSE_STEPS = 20_000  # steps between looks at the clock
_SPARE_JOINTS = 64
_NEAR = 1e-4  # m, contract: an equilibrium farther than this from the given poses is not the start


def simulate_ls_dem(
    structure,
    motion,
    parameters,
    record_times,
    time_step=1e-5,
    rotations_blocked=False,
    checkpoint=None,
    checkpoint_interval=60.0,
):
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
    checkpoint : path, optional
        Where the run is saved as it goes, and from where it goes on if it was cut short; bit-identical
        to a run in one piece. The file is taken away at the end.
    checkpoint_interval : float
        Wall time between savings [s].

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        A shape that LS-DEM cannot read, or bodies that overlap.
    """
    record_times = np.asarray(record_times, dtype=float)
    bodies, state, stoppers = assemble_bodies(structure)
    if rotations_blocked:
        bodies = bodies._replace(inverse_inertia=np.zeros_like(bodies.inverse_inertia))
    surfaces = assemble_surfaces(structure, parameters)
    interfaces = assemble_interfaces(structure, parameters)
    ground = motion.table if motion is not None else rest_table()
    n_steps = int(np.ceil(record_times[-1] / time_step - 1e-9))
    checkpoint = Path(checkpoint) if checkpoint is not None else None
    key = run_key(structure, ground, parameters, record_times, time_step, rotations_blocked)
    saved = load_checkpoint(checkpoint, key) if checkpoint is not None else None
    if saved is not None:
        progress, candidates, joints, record, started = saved
        _log.info("goes on from %.3f s", progress.clock[STEP] * time_step)
    else:
        # the stack settles on the slab as the motion starts, pitch included
        at_start = np.array([0.0, 0.0, 0.0, ground.coefficients[0, 3, 0]])
        place_driven_into(bodies, at_start, np.zeros(4), state)
        candidates, joints, started = _start(
            structure, bodies, surfaces, interfaces, parameters.skin, time_step, state
        )
        progress = start_progress(bodies, state)
        record = empty_record(len(record_times), len(structure.mass))
    limits = collapse_limits(structure)
    news, saving = Due(NEWS), Due(checkpoint_interval)
    code = PAUSED
    while code == PAUSED:
        record = with_room(record, len(joints.slip), _SPARE_JOINTS)
        pause = int(progress.clock[STEP]) + _PAUSE_STEPS
        code, body, candidates, joints = integrate(
            bodies, surfaces, interfaces, stoppers, ground, *limits, parameters.skin, time_step,
            n_steps, pause, record_times, progress, candidates, joints, record,
        )  # fmt: skip
        if news():
            _log.info("%.3f of %.3f s", progress.clock[STEP] * time_step, record_times[-1])
        if code == PAUSED and checkpoint is not None and saving():
            save_checkpoint(checkpoint, key, progress, candidates, joints, record, started)
    if checkpoint is not None:
        checkpoint.unlink(missing_ok=True)
    end_time = min(min(int(progress.clock[STEP]), n_steps) * time_step, float(record_times[-1]))
    status, reason = _status(code, structure, body, end_time)
    pairs, joint_force = _joints(structure, joints, record.joint_force, int(progress.clock[NEXT_RECORD]))
    return Trajectory(
        time=record_times,
        position=record.position,
        orientation=record.orientation,
        velocity=record.velocity,
        angular_velocity=record.angular_velocity,
        energy=record.energy,
        joints=pairs,
        joint_force=joint_force,
        status=status,
        reason=reason,
        end_time=end_time,
        numerics={
            "time_step": time_step,
            "steps": min(int(progress.clock[STEP]), n_steps),
            "settling_steps": int(started[0]),
            "stable_time_step": float(started[1]),
            "list_searches": int(progress.clock[SEARCHES]),
        },
    )


def _start(structure, bodies, surfaces, interfaces, skin, time_step, state):
    """Near nodes at the start, settling steps and stable step; the poses of stacks at rest become their equilibrium."""
    position, orientation, at_rest, left, stable_step = approach_equilibrium(
        bodies, surfaces, interfaces, skin, state, _NEAR
    )
    if time_step > stable_step:
        _log.warning(
            "a time step of %g s is above the joints' limit of stability, %.2g s", time_step, stable_step
        )
    relaxed = state._replace(position=position, orientation=orientation)
    candidates, joints, steps = settle(
        bodies, surfaces, interfaces, skin, time_step, state, relaxed, _NEAR, at_rest, left,
        empty_candidates(len(bodies.mass)), no_joints(),
    )  # fmt: skip
    _check_overlap(structure, candidates)
    free = ~structure.driven
    _, group = connected_components(structure.touching & free[:, None] & free[None, :])
    settled = free & ~np.isin(group, group[left])
    state.position[settled] = relaxed.position[settled]
    state.orientation[settled] = relaxed.orientation[settled]
    # what was slipped on the way to the equilibrium is not the run's
    joints.slip[:], joints.slip_rate[:], joints.touched[:] = 0.0, 0.0, False
    for pair, (a, b) in enumerate(candidates.pairs):
        if not (settled[a] or settled[b]):
            first, last = candidates.first[2 * pair], candidates.first[2 * pair + 2]
            candidates.packets[first:last, STRETCH_X:FORCE_X] = 0.0
    return candidates, joints, np.array([steps, stable_step])


def _check_overlap(structure, candidates):
    """Refuse bodies that start inside one another: where one is not convex, the structure's own check is blind."""
    depth = -candidates.packets[:, PHI:NORMAL_X]
    if depth.max(initial=0.0) > DEEPEST_OVERLAP:
        side = np.searchsorted(candidates.first, depth.max(axis=1).argmax(), side="right") - 1
        a, b = candidates.pairs[side // 2]
        raise InputError(
            structure.source,
            f"bodies.{structure.body_names[b]}.position",
            f"overlaps {structure.body_names[a]} by {1e3 * depth.max():.3g} mm; "
            f"expected at most {1e3 * DEEPEST_OVERLAP:.0f} mm",
        )


def _status(code, structure, body, time):
    if code == COLLAPSED:
        return "collapsed", f"{structure.body_names[body]} fell or overturned by {time:.3f} s"
    if code == DIVERGED:
        return "diverged", f"a velocity grew beyond 1000 m/s or was no number at {time:.6f} s"
    return "completed", ""


def _joints(structure, joints, force, n_recorded):
    """Pairs that touched, lower body first, ordered by index, with the force on the upper one."""
    rows = np.flatnonzero(joints.touched)
    rows = rows[np.lexsort(joints.pair[rows].T[::-1])]
    pairs = joints.pair[rows]
    height = structure.centroid[:, 2]
    swapped = height[pairs[:, 0]] > height[pairs[:, 1]]
    force = force[:, rows] * np.where(swapped, -1.0, 1.0)[None, :, None]
    force[n_recorded:] = np.nan
    return np.where(swapped[:, None], pairs[:, ::-1], pairs), force
