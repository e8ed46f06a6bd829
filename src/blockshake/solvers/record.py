"""Record of a run at the times requested, which every solver fills in, and how the run ended."""

import sys
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import ENERGY_TERMS, Rows, Status
from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel, kernel_without_allocation

COMPLETED, COLLAPSED, DIVERGED, PAUSED = 0, 1, 2, 3
# First entries of a solver's ``clock``: next step (so the number of steps made), and next record
STEP, NEXT_RECORD = 0, 1
# m/s; nothing that falls or shakes comes near it: a faster body means that the run has diverged
SPEED_LIMIT = 1e3
_SPARE_JOINTS = 16
_LEAST_STEPS = 3  # of a record that is not of all times: a step in which it is filled, and one before


class RunRecord(NamedTuple):
    """Rows of `Rows` that are at hand, ``joint_force`` for all joints; NaN at times that the run did not reach.

    ``first`` int64 (1,): number of the first of these rows among the times requested.
    """

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    energy: np.ndarray
    joint_force: np.ndarray
    first: np.ndarray


def empty_record(first, n_rows, n_bodies, room=0):
    """Record of some rows before the first of them, with room for so many joints."""
    return RunRecord(
        position=np.full((n_rows, n_bodies, 3), np.nan),
        orientation=np.full((n_rows, n_bodies, 4), np.nan),
        velocity=np.full((n_rows, n_bodies, 3), np.nan),
        angular_velocity=np.full((n_rows, n_bodies, 3), np.nan),
        energy=np.full((n_rows, len(ENERGY_TERMS)), np.nan),
        joint_force=np.zeros((n_rows, room, 3)),
        first=np.array([first]),
    )


def rows_at_hand(times, first, step, time_step, most):
    """Number of rows of a record that begins with row ``first`` at step ``step``: ``most``, or those of three steps."""
    needed = np.searchsorted(times, (step + _LEAST_STEPS) * time_step, "right") - first
    return int(min(max(most, needed), len(times) - first))


def last_step(times, record, time_step):
    """Number of steps that surely fit into a record; without end for one that reaches the last time."""
    until = int(record.first[0]) + len(record.energy)
    return int(times[until] / time_step) - 1 if until < len(times) else sys.maxsize


def recorded_rows(times, progress, record, pairs, joint_force, bodies=slice(None)):
    """`Rows` of a record, from the progress of its run.

    ``pairs`` (n_joints, 2) and ``joint_force`` (n_rows, n_joints, 3): of the joints, force NaN afterwards at times that
    the run did not reach. ``bodies``: rows of the record's bodies in the order of the file.
    """
    first = int(record.first[0])
    joint_force[progress.clock[NEXT_RECORD] - first :] = np.nan
    return Rows(
        time=times[first : first + len(record.energy)],
        position=record.position[:, bodies],
        orientation=record.orientation[:, bodies],
        velocity=record.velocity[:, bodies],
        angular_velocity=record.angular_velocity[:, bodies],
        energy=record.energy,
        joints=pairs,
        joint_force=joint_force,
    )


def status_at_end(code, name, time):
    """Status of a run that ended with a code, and the reason in words; ``name``: of the body that ended it."""
    if code == COLLAPSED:
        return Status.COLLAPSED, f"{name} tipped over or dropped by {time:.3f} s"
    if code == DIVERGED:
        return Status.DIVERGED, f"{name} is faster than {SPEED_LIMIT:.0f} m/s or not finite at {time:.6g} s"
    return Status.COMPLETED, ""


@inner_kernel
def with_room(record, n_joints):
    """The record, grown where it cannot hold so many joints; a new joint has carried nothing so far."""
    n_times = record.joint_force.shape[0]
    if n_joints <= record.joint_force.shape[1]:
        return record
    force = np.zeros((n_times, n_joints + n_joints // 4 + _SPARE_JOINTS, 3))
    copy_into(record.joint_force, force)
    return RunRecord(
        record.position,
        record.orientation,
        record.velocity,
        record.angular_velocity,
        record.energy,
        force,
        record.first,
    )


@kernel_without_allocation
def find_diverged(state):
    """First body whose state is not finite or that is faster than anything real, or -1."""
    for body in range(state.position.shape[0]):
        speed = 0.0
        for axis in range(3):
            speed += abs(state.velocity[body, axis]) + abs(state.angular_velocity[body, axis])
            speed += 0.0 * state.position[body, axis]
        # not (x < y), so that NaN counts
        if not speed < SPEED_LIMIT:
            return body
    return -1
