"""Nonsmooth contact dynamics of rigid convex bodies: one call, one trajectory."""

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import MotionTable
from blockshake.dynamics.system import ENERGY_TERMS, Trajectory, assemble_bodies
from blockshake.solvers.nscd.loop import COLLAPSED, DIVERGED, Record, Settings, Watch, run
from blockshake.solvers.nscd.polyhedra import pack_polyhedra

# Share of badly solved steps above which a run is not to be trusted; fixed by the project's contract.
_MOST_BAD_STEPS = 0.01


def simulate_nscd(structure, motion, parameters, record_times, time_step=1e-3):
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

    Returns
    -------
    Trajectory
        Between steps, positions, velocities and energies are linear and orientations follow the
        rotation of the step; a joint's force is the mean over the step in which the time falls.
        ``numerics``: ``steps``, ``mean_iterations``, ``max_iterations``, ``max_residual``,
        ``fraction_above_1e-4`` (of the steps, by residual), ``capped_steps`` (stopped short of the tolerance),
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
    order = np.lexsort((structure.position[:, 1], structure.position[:, 0], structure.position[:, 2]))
    bodies, state, stoppers = (_reordered(part, order) for part in assemble_bodies(structure))
    place = np.argsort(order)
    stoppers = stoppers._replace(body=place[stoppers.body])
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
    )
    record = _empty_record(np.ascontiguousarray(record_times, dtype=float), len(order))
    code, culprit, end_time, joints, joint_force, tally = run(
        bodies,
        state,
        stoppers,
        pack_polyhedra(structure, order),
        _table(motion),
        settings,
        watch,
        record,
    )
    status, reason = "completed", ""
    if code in (COLLAPSED, DIVERGED):
        name = structure.body_names[order[culprit]]
        status = "collapsed" if code == COLLAPSED else "diverged"
        what = "tipped over or dropped" if code == COLLAPSED else "is faster than 1000 m/s or not finite"
        reason = f"{name} {what} at {end_time:.3f} s"
    steps = max(tally.steps, 1)
    if code != DIVERGED and tally.bad_steps > _MOST_BAD_STEPS * steps:
        words = (
            f"{100.0 * tally.bad_steps / steps:.1f} % of the steps ended above a relative residual of 1e-4"
        )
        status, reason = "not-converged", "; ".join(part for part in (words, reason) if part)
    return Trajectory(
        time=record.time,
        position=record.position[:, place],
        orientation=record.orientation[:, place],
        velocity=record.velocity[:, place],
        angular_velocity=record.angular_velocity[:, place],
        energy=record.energy,
        joints=order[joints],
        joint_force=joint_force,
        status=status,
        reason=reason,
        end_time=end_time,
        numerics={
            "steps": tally.steps,
            "mean_iterations": tally.sweeps / steps,
            "max_iterations": tally.most_sweeps,
            "max_residual": tally.worst_residual,
            "fraction_above_1e-4": tally.bad_steps / steps,
            "capped_steps": tally.capped_steps,
            "energy_residual": tally.energy_residual / tally.energy_scale
            if tally.energy_scale > 0.0
            else 0.0,
            "max_penetration": tally.deepest,
        },
    )


def _reordered(part, order):
    """Bodies, State or Stoppers with their bodies in another order; stoppers stay as they are."""
    if type(part).__name__ == "Stoppers":
        return part
    fields = {}
    for name, values in part._asdict().items():
        if name == "friction":
            values = values[np.ix_(order, order)]
        elif name != "gravity":
            values = values[order]
        fields[name] = np.ascontiguousarray(values)
    return type(part)(**fields)


def _empty_record(times, n_bodies):
    vectors = (len(times), n_bodies, 3)
    return Record(
        times,
        np.full(vectors, np.nan),
        np.full((len(times), n_bodies, 4), np.nan),
        np.full(vectors, np.nan),
        np.full(vectors, np.nan),
        np.full((len(times), len(ENERGY_TERMS)), np.nan),
    )


def _table(motion):
    """The motion's polynomials, or those of rest."""
    if motion is None:
        return MotionTable(np.array([0.0, 1.0]), np.zeros((1, 4, 4)))
    return MotionTable(*(np.ascontiguousarray(part) for part in motion.table))
