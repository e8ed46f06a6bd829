"""LS-DEM from a structure and a motion to a trajectory."""

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import PITCH, rest_table
from blockshake.dynamics.system import Rows, Trajectory, assemble_bodies, place_driven_into
from blockshake.solvers.checkpoint import Checkpoint, run_key
from blockshake.solvers.external_forces import assemble_external_forces
from blockshake.solvers.ls_dem import checkpoint as layout
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.loop import integrate
from blockshake.solvers.ls_dem.progress import SEARCHES, start_progress
from blockshake.solvers.ls_dem.start.settled_start import settled_start
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces
from blockshake.solvers.pieces import run_in_pieces
from blockshake.solvers.status import COLLAPSED, DIVERGED, NEXT_RECORD, SPEED_LIMIT, STATUS, STEP


def simulate_ls_dem(
    structure,
    motion,
    parameters,
    record_times,
    time_step=1e-5,
    rotations_blocked=False,
    checkpoint=None,
    checkpoint_interval=60.0,
    kept=None,
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
        File that a run which was cut short goes on from, see `run_in_pieces`.
    checkpoint_interval : float
        Wall time between savings [s].
    kept : KeptRows, optional
        Where rows of the record go as the run goes on; the trajectory then has the last ones alone.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        A shape that LS-DEM cannot read, or bodies that overlap.
    KeyboardInterrupt
        See `run_in_pieces`.
    """
    record_times = np.asarray(record_times, dtype=float)
    bodies, state, stoppers = assemble_bodies(structure)
    if rotations_blocked:
        bodies = bodies._replace(inverse_inertia=np.zeros_like(bodies.inverse_inertia))
    forces = assemble_external_forces(structure)
    surfaces = assemble_surfaces(structure, parameters)
    interfaces = assemble_interfaces(structure, parameters)
    ground = motion.table if motion is not None else rest_table()
    n_steps = int(np.ceil(record_times[-1] / time_step - 1e-9))
    limits = collapse_limits(structure)

    def start():
        # the stack settles on the slab as the motion starts, pitch included
        at_start = np.zeros(4)
        at_start[PITCH] = ground.coefficients[0, PITCH, 0]
        place_driven_into(bodies, at_start, np.zeros(4), state)
        candidates, joints, started = settled_start(
            structure, bodies, surfaces, interfaces, parameters.skin, time_step, state
        )
        return start_progress(bodies, state), candidates, joints, started

    def go_on(pause, progress, candidates, joints, started, record):
        code, culprit, candidates, joints, record = integrate(
            bodies, surfaces, interfaces, stoppers, forces, ground, *limits, parameters.skin, time_step,
            n_steps, pause, record_times, progress, candidates, joints, record,
        )  # fmt: skip
        return code, culprit, (progress, candidates, joints, started, record)

    def rows(progress, _, joints, started, record):
        return _rows_of(structure, record_times, progress, joints, record)

    key = run_key(structure, ground, parameters, record_times, time_step, rotations_blocked)
    saving = Checkpoint(checkpoint, checkpoint_interval, key, layout)
    code, body, parts = run_in_pieces(start, go_on, rows, record_times, time_step, saving, kept)
    progress, _, _, started, _ = parts
    end_time = min(min(int(progress.clock[STEP]), n_steps) * time_step, float(record_times[-1]))
    status, reason = _status(code, structure, body, end_time)
    return Trajectory(
        **vars(rows(*parts)),
        status=status,
        reason=reason,
        end_time=end_time,
        numerics={
            "time_step": time_step,
            "steps": min(int(progress.clock[STEP]), n_steps),
            "settling_steps": int(started[0]),
            "stable_time_step": float(started[1]),
            "overlap_as_laid": float(started[2]),
            "list_searches": int(progress.clock[SEARCHES]),
        },
    )


def _status(code, structure, body, time):
    reason = ""
    if code == COLLAPSED:
        reason = f"{structure.body_names[body]} fell or overturned by {time:.3f} s"
    if code == DIVERGED:
        reason = f"a velocity grew beyond {SPEED_LIMIT:.0f} m/s or was no number at {time:.6f} s"
    return STATUS[code], reason


def _rows_of(structure, times, progress, joints, record):
    """`Rows` of a run's record."""
    first, n_rows = int(record.first[0]), len(record.energy)
    pairs, force = _joints(structure, joints, record.joint_force, int(progress.clock[NEXT_RECORD]) - first)
    return Rows(
        time=times[first : first + n_rows],
        position=record.position,
        orientation=record.orientation,
        velocity=record.velocity,
        angular_velocity=record.angular_velocity,
        energy=record.energy,
        joints=pairs,
        joint_force=force,
    )


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
