"""Nonsmooth contact dynamics of rigid convex bodies: one call, one trajectory."""

import functools

import numpy as np

from blockshake.dynamics.system import Status, Trajectory, assemble_bodies
from blockshake.solvers.checkpoint import Checkpoint, run_key
from blockshake.solvers.nscd.contact.contacts import Contacts, empty_contacts
from blockshake.solvers.nscd.loop import integrate
from blockshake.solvers.nscd.progress import (
    BAD_STEPS,
    CAPPED_STEPS,
    DEEPEST,
    IN_PLAY,
    ITERATIONS,
    MISFIT,
    MOST_ITERATIONS,
    PARTED_STEPS,
    WORST_RESIDUAL,
    Joints,
    Progress,
    no_joints,
    start_progress,
)
from blockshake.solvers.nscd.scene import assemble_scene, order_of_bodies, reordered
from blockshake.solvers.nscd.start import settled_state
from blockshake.solvers.pieces import run_in_pieces
from blockshake.solvers.record import (
    DIVERGED,
    STEP,
    RunRecord,
    recorded_rows,
    status_at_end,
)

# Share of badly solved steps above which a run is not to be trusted; fixed by the project's contract.
_MOST_BAD_STEPS = 0.01


def simulate_nscd(structure, motion, parameters, record_times, time_step=1e-3, checkpoint=None, kept=None):
    """Motion of rigid blocks with Signorini's condition and Coulomb's friction at their contacts.

    Parameters
    ----------
    structure : Structure
    motion : GroundMotion or None
        Motion of the driven bodies; None keeps them at rest.
    parameters : NscdParameters
    record_times : float64 array, shape (n_times,)
        Increasing, the first is 0 [s]; the run ends at the last.
    time_step : float
        [s]
    checkpoint : path, optional
        File that a run which was cut short goes on from, see `run_in_pieces`.
    kept : KeptRows, optional
        Where rows of the record go as the run goes on; the trajectory then has the last ones alone.

    Returns
    -------
    Trajectory
        Between steps, positions, velocities and energies are linear and orientations follow the rotation of the step; a
        joint's force is the mean over the step in which the time falls. ``numerics``: ``steps``, ``mean_iterations``,
        ``max_iterations``, ``max_residual``, ``fraction_unconverged`` (of the steps, by residual), ``capped_steps``
        (stopped short of the tolerance), ``parted_steps`` (in which bodies met, with ``impact_parts``),
        ``energy_residual`` (largest misfit of the energy terms, relative to the energy in play) and ``max_penetration``
        [m].

    Raises
    ------
    InputError
        A shape is not convex.
    KeyboardInterrupt
        See `run_in_pieces`.

    Notes
    -----
    Theta scheme of Moreau (1988) and Jean (1999) as in Dubois et al. (2018); ``docs/theory/nscd.md`` has the equations.
    Bodies are handled from the lowest upwards, whatever their order in the file.
    """
    times = np.ascontiguousarray(record_times, dtype=float)
    order = order_of_bodies(structure)
    bodies, given, stoppers = assemble_bodies(structure, motion)
    scene = assemble_scene(structure, bodies, given, stoppers, motion, parameters, time_step, order)

    def start():
        touching = structure.touching[np.ix_(order, order)]
        progress = start_progress(settled_state(scene, touching, reordered(given, order)))
        return progress, empty_contacts(0), no_joints(len(order))

    def rows(progress, _, joints, record):
        return rows_of(order, times, progress, joints, record)

    go_on = functools.partial(integrate, scene, times)
    key = run_key(structure, scene.table, parameters, times, time_step)
    saving = Checkpoint(checkpoint, key, (Progress, Contacts, Joints, RunRecord))
    code, culprit, parts = run_in_pieces(start, go_on, rows, times, time_step, saving, kept)
    progress, _, joints, record = parts
    return trajectory_of(structure, order, times, time_step, code, culprit, progress, joints, record)


def trajectory_of(structure, order, times, time_step, code, culprit, progress, joints, record):
    """`Trajectory` of a run from what `integrate` leaves at its end, with the rows of the record.

    ``order`` int64 (n_bodies,) from `order_of_bodies`; ``times`` (n_times,) and ``time_step`` [s].
    """
    steps = int(progress.clock[STEP])
    end_time = min(steps * time_step, float(times[-1]))
    status, reason = status_at_end(code, structure.body_names[order[culprit]], end_time)
    bad = progress.clock[BAD_STEPS] / max(steps, 1)
    if code != DIVERGED and bad > _MOST_BAD_STEPS:
        words = f"{100.0 * bad:.1f} % of the steps ended above a relative residual of 1e-4"
        status, reason = Status.NOT_CONVERGED, "; ".join(part for part in (words, reason) if part)
    return Trajectory(
        **vars(rows_of(order, times, progress, joints, record)),
        status=status,
        reason=reason,
        end_time=end_time,
        numerics=_numerics(progress),
    )


def rows_of(order, times, progress, joints, record):
    """`Rows` of a run's record, bodies in the order of the file, by the arguments of `trajectory_of`."""
    # a run that ends in its first step has found its joints and made no room for them
    joint_force = np.zeros((len(record.energy), len(joints.slip), 3))
    recorded = record.joint_force[:, : len(joints.slip)]
    joint_force[:, : recorded.shape[1]] = recorded
    return recorded_rows(times, progress, record, order[joints.pair], joint_force, np.argsort(order))


def _numerics(progress):
    clock, audit = progress.clock, progress.audit
    steps = max(int(clock[STEP]), 1)
    return {
        "steps": int(clock[STEP]),
        "mean_iterations": int(clock[ITERATIONS]) / steps,
        "max_iterations": int(clock[MOST_ITERATIONS]),
        "max_residual": float(audit[WORST_RESIDUAL]),
        "fraction_unconverged": int(clock[BAD_STEPS]) / steps,
        "capped_steps": int(clock[CAPPED_STEPS]),
        "parted_steps": int(clock[PARTED_STEPS]),
        "energy_residual": float(audit[MISFIT] / audit[IN_PLAY]) if audit[IN_PLAY] > 0.0 else 0.0,
        "max_penetration": float(audit[DEEPEST]),
    }
