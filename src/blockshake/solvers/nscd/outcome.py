"""A finished NSCD run as a trajectory: status, figures of the computation, bodies in the order of the file."""

import numpy as np

from blockshake.dynamics.system import Status, Trajectory
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
)
from blockshake.solvers.record import recorded_rows
from blockshake.solvers.status import COLLAPSED, DIVERGED, SPEED_LIMIT, STATUS, STEP

# Share of badly solved steps above which a run is not to be trusted; fixed by the project's contract.
_MOST_BAD_STEPS = 0.01


def trajectory_of(structure, order, times, time_step, code, culprit, progress, joints, record):
    """`Trajectory` of a run from what `integrate` leaves at its end, with the rows of the record.

    ``order`` int64 (n_bodies,) from `order_of_bodies`; ``times`` (n_times,) and ``time_step`` [s].
    """
    end_time = min(int(progress.clock[STEP]) * time_step, float(times[-1]))
    name = structure.body_names[order[culprit]]
    status, reason = _status(code, name, end_time, progress.clock)
    return Trajectory(
        **vars(rows_of(order, times, progress, joints, record)),
        status=status,
        reason=reason,
        end_time=end_time,
        numerics=_numerics(progress),
    )


def rows_of(order, times, progress, joints, record):
    """`Rows` of a run's record, bodies in the order of the file; arguments as of `trajectory_of`."""
    # a run that ends in its first step has found its joints and made no room for them
    joint_force = np.zeros((len(record.energy), len(joints.slip), 3))
    recorded = record.joint_force[:, : len(joints.slip)]
    joint_force[:, : recorded.shape[1]] = recorded
    return recorded_rows(times, progress, record, order[joints.pair], joint_force, np.argsort(order))


def _status(code, name, end_time, clock):
    status, reason = STATUS[code], ""
    if code == COLLAPSED:
        reason = f"{name} tipped over or dropped at {end_time:.3f} s"
    if code == DIVERGED:
        reason = f"{name} is faster than {SPEED_LIMIT:.0f} m/s or not finite at {end_time:.3f} s"
    bad = clock[BAD_STEPS] / max(clock[STEP], 1)
    if code != DIVERGED and bad > _MOST_BAD_STEPS:
        words = f"{100.0 * bad:.1f} % of the steps ended above a relative residual of 1e-4"
        status, reason = Status.NOT_CONVERGED, "; ".join(part for part in (words, reason) if part)
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
