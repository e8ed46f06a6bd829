"""LS-DEM from a structure and a motion to a trajectory."""

import functools
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import MotionTable, rest_table
from blockshake.dynamics.system import Bodies, Stoppers, Trajectory, assemble_bodies
from blockshake.solvers.checkpoint import Checkpoint, run_key
from blockshake.solvers.external_forces import ExternalForces, assemble_external_forces
from blockshake.solvers.ls_dem.contact.candidates import Candidates
from blockshake.solvers.ls_dem.interfaces import Interfaces, assemble_interfaces
from blockshake.solvers.ls_dem.loop import integrate
from blockshake.solvers.ls_dem.progress import SEARCHES, LeapfrogProgress, NearPairs, start_progress
from blockshake.solvers.ls_dem.start.settled_start import settled_start
from blockshake.solvers.ls_dem.surfaces import Surfaces, assemble_surfaces
from blockshake.solvers.pieces import run_in_pieces
from blockshake.solvers.record import (
    STEP,
    RunRecord,
    recorded_rows,
    status_at_end,
)


class Assembly(NamedTuple):
    """Bodies and what acts on them.

    ``table``: motion of the driven bodies. ``supported``, ``drop_limit`` (n_bodies,): of `collapse_limits`. ``skin``:
    reach of the lists of near nodes [m]. ``dt`` [s], ``n_steps``: number of the last step.
    """

    bodies: Bodies
    surfaces: Surfaces
    interfaces: Interfaces
    stoppers: Stoppers | None
    forces: ExternalForces | None
    table: MotionTable
    supported: np.ndarray
    drop_limit: np.ndarray
    skin: float
    dt: float
    n_steps: int


def simulate_ls_dem(
    structure,
    motion,
    parameters,
    record_times,
    time_step=1e-5,
    rotations_blocked=False,
    checkpoint=None,
    kept=None,
):
    """Run LS-DEM.

    Parameters
    ----------
    structure : Structure
    motion : GroundMotion or None
        Motion of the driven bodies; None lets them rest.
    parameters : LsDemParameters
    record_times : float64 array, shape (n_times,)
        Increasing from 0 [s].
    time_step : float
        [s]
    rotations_blocked : bool
        No body turns: what the shear stiffness is calibrated with.
    checkpoint : path, optional
        File that a run which was cut short goes on from, see `run_in_pieces`.
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
    bodies, state, stoppers = assemble_bodies(structure, motion)
    if rotations_blocked:
        bodies = bodies._replace(inverse_inertia=np.zeros_like(bodies.inverse_inertia))
    n_steps = int(np.ceil(record_times[-1] / time_step - 1e-9))
    assembly = Assembly(
        bodies,
        assemble_surfaces(structure, parameters),
        assemble_interfaces(structure, parameters),
        stoppers,
        assemble_external_forces(structure, state),
        rest_table() if motion is None else motion.table,
        *collapse_limits(structure),
        parameters.skin,
        time_step,
        n_steps,
    )

    def start():
        candidates, joints, started = settled_start(structure, assembly, state)
        return start_progress(bodies, state, started), candidates, joints

    def rows(progress, _, joints, record):
        return _rows_of(structure, record_times, progress, joints, record)

    go_on = functools.partial(integrate, assembly, record_times)
    key = run_key(structure, assembly.table, parameters, record_times, time_step, rotations_blocked)
    saving = Checkpoint(checkpoint, key, (LeapfrogProgress, Candidates, NearPairs, RunRecord))
    code, body, parts = run_in_pieces(start, go_on, rows, record_times, time_step, saving, kept)
    progress = parts[0]
    steps = min(int(progress.clock[STEP]), n_steps)
    end_time = min(steps * time_step, float(record_times[-1]))
    status, reason = status_at_end(code, structure.body_names[body], end_time)
    return Trajectory(
        **vars(rows(*parts)),
        status=status,
        reason=reason,
        end_time=end_time,
        numerics={
            "time_step": time_step,
            "steps": steps,
            "settling_steps": int(progress.started[0]),
            "stable_time_step": float(progress.started[1]),
            "overlap_as_laid": float(progress.started[2]),
            "list_searches": int(progress.clock[SEARCHES]),
        },
    )


def _rows_of(structure, times, progress, joints, record):
    """`Rows` of a run's record: pairs that touched, lower body first, ordered by index."""
    rows = np.flatnonzero(joints.touched)
    rows = rows[np.lexsort(joints.pair[rows].T[::-1])]
    pairs, height = joints.pair[rows], structure.centroid[:, 2]
    swapped = height[pairs[:, 0]] > height[pairs[:, 1]]
    force = record.joint_force[:, rows] * np.where(swapped, -1.0, 1.0)[None, :, None]
    pairs = np.where(swapped[:, None], pairs[:, ::-1], pairs)
    return recorded_rows(times, progress, record, pairs, force)
