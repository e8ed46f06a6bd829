"""Nonsmooth contact dynamics of rigid convex bodies: one call, one trajectory."""

import logging
import time
from pathlib import Path

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.joint_layers import joint_compliance
from blockshake.dynamics.motion import MotionTable, rest_table
from blockshake.dynamics.system import Trajectory, assemble_bodies
from blockshake.solvers.checkpoint import NEWS, Due, run_key
from blockshake.solvers.nscd.checkpoint import load_checkpoint, save_checkpoint
from blockshake.solvers.nscd.contacts import empty_contacts
from blockshake.solvers.nscd.friction import ordered_friction
from blockshake.solvers.nscd.joints import no_joints
from blockshake.solvers.nscd.loop import COLLAPSED, DIVERGED, PAUSED, Settings, Watch, integrate
from blockshake.solvers.nscd.polyhedra import pack_polyhedra
from blockshake.solvers.nscd.progress import (
    BAD_STEPS,
    CAPPED_STEPS,
    DEEPEST,
    IN_PLAY,
    ITERATIONS,
    MISFIT,
    MOST_ITERATIONS,
    NEXT_RECORD,
    PARTED_STEPS,
    STEP,
    WORST_RESIDUAL,
    start_progress,
)
from blockshake.solvers.nscd.start import settled_state
from blockshake.solvers.record import empty_record

_log = logging.getLogger(__name__)
# Share of badly solved steps above which a run is not to be trusted; fixed by the project's contract.
_MOST_BAD_STEPS = 0.01
# Steps between looks at the clock, doubled as long as they take less than _PIECE.
_PAUSE_STEPS = 100
_PIECE = 0.5  # s of wall time


def simulate_nscd(
    structure, motion, parameters, record_times, time_step=1e-3, checkpoint=None, checkpoint_interval=60.0
):
    """Motion of rigid blocks with Signorini's condition and Coulomb's friction at their contacts.

    Parameters
    ----------
    structure : Structure
    motion : GroundMotion or None
        Of the driven bodies; None keeps them at rest.
    parameters : NscdParameters
    record_times : float64 array, shape (n_times,)
        Increasing, the first is 0 [s]; the run ends at the last.
    time_step : float
        [s]
    checkpoint : path, optional
        Where the run is saved as it goes, and from where it goes on if it was cut short; bit-identical
        to a run in one piece. The file is taken away at the end.
    checkpoint_interval : float
        Wall time between savings [s].

    Returns
    -------
    Trajectory
        Between steps, positions, velocities and energies are linear and orientations follow the
        rotation of the step; a joint's force is the mean over the step in which the time falls.
        ``numerics``: ``steps``, ``mean_iterations``, ``max_iterations``, ``max_residual``,
        ``fraction_above_1e-4`` (of the steps, by residual), ``capped_steps`` (stopped short of the tolerance),
        ``parted_steps`` (in which bodies met, with ``impact_parts``),
        ``energy_residual`` (largest misfit of the energy terms, relative to the energy in play)
        and ``max_penetration`` [m].

    Raises
    ------
    InputError
        A shape is not convex.

    Notes
    -----
    Theta scheme of Moreau (1988) and Jean (1999) as in Dubois et al. (2018); ``docs/nscd.md`` has the equations.
    Bodies are handled from the lowest upwards, whatever their order in the file.
    """
    times = np.ascontiguousarray(record_times, dtype=float)
    centroid = structure.centroid
    order = np.lexsort((centroid[:, 1], centroid[:, 0], centroid[:, 2]))
    place = np.argsort(order)
    bodies, state, stoppers = assemble_bodies(structure)
    bodies = _reordered(bodies._replace(gravity=None), order)._replace(gravity=bodies.gravity)
    stoppers = stoppers._replace(body=place[stoppers.body])
    polyhedra, friction = pack_polyhedra(structure, order), ordered_friction(structure, order)
    layers = np.ascontiguousarray(joint_compliance(structure)[np.ix_(order, order)])
    ground = rest_table() if motion is None else motion.table
    ground = MotionTable(*(np.ascontiguousarray(part) for part in ground))
    driven = np.flatnonzero(structure.driven)
    supported, drop_limit = collapse_limits(structure)
    watch = Watch(supported[order], drop_limit[order], int(place[driven[0]]) if len(driven) else -1)
    settings = Settings(
        float(time_step),
        parameters.theta,
        parameters.tolerance,
        parameters.max_iterations,
        parameters.shrink,
        structure.file.nscd_restitution,
        parameters.impact_parts,
    )
    checkpoint = Path(checkpoint) if checkpoint is not None else None
    key = run_key(structure, ground, parameters, times, time_step)
    saved = load_checkpoint(checkpoint, key) if checkpoint is not None else None
    if saved is not None:
        progress, contacts, joints, record = saved
        _log.info("goes on from %.3f s", progress.clock[STEP] * time_step)
    else:
        touching = structure.touching[np.ix_(order, order)]
        state = settled_state(
            bodies, friction, polyhedra, layers, touching, ground, parameters.shrink, _reordered(state, order)
        )
        progress, contacts = start_progress(state), empty_contacts(0)
        joints, record = no_joints(len(order)), empty_record(len(times), len(order))
    news, saving = Due(NEWS), Due(checkpoint_interval)
    code, steps = PAUSED, _PAUSE_STEPS
    while code == PAUSED:
        began = time.monotonic()
        code, culprit, contacts, joints, record = integrate(
            bodies, friction, stoppers, layers, polyhedra, ground, settings, watch, times,
            int(progress.clock[STEP]) + steps, progress, contacts, joints, record,
        )  # fmt: skip
        if time.monotonic() - began < _PIECE:
            steps *= 2
        if news():
            _log.info("%.3f of %.3f s", progress.clock[STEP] * time_step, times[-1])
        if code == PAUSED and checkpoint is not None and saving():
            save_checkpoint(checkpoint, key, progress, contacts, joints, record)
    if checkpoint is not None:
        checkpoint.unlink(missing_ok=True)
    end_time = min(int(progress.clock[STEP]) * time_step, float(times[-1]))
    name = structure.body_names[order[culprit]]
    status, reason = _status(code, name, end_time, progress.clock)
    joint_force = record.joint_force[:, : len(joints.slip)]
    joint_force[progress.clock[NEXT_RECORD] :] = np.nan
    return Trajectory(
        time=times,
        position=record.position[:, place],
        orientation=record.orientation[:, place],
        velocity=record.velocity[:, place],
        angular_velocity=record.angular_velocity[:, place],
        energy=record.energy,
        joints=order[joints.pair],
        joint_force=np.ascontiguousarray(joint_force),
        status=status,
        reason=reason,
        end_time=end_time,
        numerics=_numerics(progress),
    )


def _reordered(part, order):
    """Bodies or State with their bodies in another order."""
    return type(part)(*(values if values is None else np.ascontiguousarray(values[order]) for values in part))


def _status(code, name, end_time, clock):
    status, reason = "completed", ""
    if code in (COLLAPSED, DIVERGED):
        status = "collapsed" if code == COLLAPSED else "diverged"
        what = "tipped over or dropped" if code == COLLAPSED else "is faster than 1000 m/s or not finite"
        reason = f"{name} {what} at {end_time:.3f} s"
    bad = clock[BAD_STEPS] / max(clock[STEP], 1)
    if code != DIVERGED and bad > _MOST_BAD_STEPS:
        words = f"{100.0 * bad:.1f} % of the steps ended above a relative residual of 1e-4"
        status, reason = "not-converged", "; ".join(part for part in (words, reason) if part)
    return status, reason


def _numerics(progress):
    clock, audit = progress.clock, progress.audit
    steps = max(int(clock[STEP]), 1)
    return {
        "steps": int(clock[STEP]),
        "mean_iterations": int(clock[ITERATIONS]) / steps,
        "max_iterations": int(clock[MOST_ITERATIONS]),
        "max_residual": float(audit[WORST_RESIDUAL]),
        "fraction_above_1e-4": int(clock[BAD_STEPS]) / steps,
        "capped_steps": int(clock[CAPPED_STEPS]),
        "parted_steps": int(clock[PARTED_STEPS]),
        "energy_residual": float(audit[MISFIT] / audit[IN_PLAY]) if audit[IN_PLAY] > 0.0 else 0.0,
        "max_penetration": float(audit[DEEPEST]),
    }
