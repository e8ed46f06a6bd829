"""Nonsmooth contact dynamics of rigid convex bodies: one call, one trajectory."""

import functools

import numpy as np

from blockshake.dynamics.system import assemble_bodies
from blockshake.solvers.checkpoint import Checkpoint, run_key
from blockshake.solvers.nscd.contact.contacts import Contacts, empty_contacts
from blockshake.solvers.nscd.joints import Joints, no_joints
from blockshake.solvers.nscd.loop import integrate
from blockshake.solvers.nscd.outcome import rows_of, trajectory_of
from blockshake.solvers.nscd.progress import Progress, start_progress
from blockshake.solvers.nscd.scene import assemble_scene, order_of_bodies, reordered
from blockshake.solvers.nscd.start import settled_state
from blockshake.solvers.pieces import run_in_pieces
from blockshake.solvers.record import RunRecord


def simulate_nscd(structure, motion, parameters, record_times, time_step=1e-3, checkpoint=None, kept=None):
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
        File that a run which was cut short goes on from, see `run_in_pieces`.
    kept : KeptRows, optional
        Where rows of the record go as the run goes on; the trajectory then has the last ones alone.

    Returns
    -------
    Trajectory
        Between steps, positions, velocities and energies are linear and orientations follow the rotation of the step; a
        joint's force is the mean over the step in which the time falls. ``numerics``: ``steps``, ``mean_iterations``,
        ``max_iterations``, ``max_residual``, ``fraction_above_1e-4`` (of the steps, by residual), ``capped_steps``
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
    bodies, given, stoppers = assemble_bodies(structure)
    scene = assemble_scene(structure, bodies, stoppers, motion, parameters, time_step, order)

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
