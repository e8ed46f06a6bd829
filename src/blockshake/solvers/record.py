"""Record of a run at the times asked for: both solvers fill it in as they go."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.jit import kernel

_SPARE_JOINTS = 16


class Record(NamedTuple):
    """Arrays as in `Trajectory`, ``joint_force`` for all joints; NaN at times that the run did not reach."""

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    energy: np.ndarray
    joint_force: np.ndarray


def empty_record(n_times, n_bodies):
    """Record before the first time, without room for joints."""
    return Record(
        position=np.full((n_times, n_bodies, 3), np.nan),
        orientation=np.full((n_times, n_bodies, 4), np.nan),
        velocity=np.full((n_times, n_bodies, 3), np.nan),
        angular_velocity=np.full((n_times, n_bodies, 3), np.nan),
        energy=np.full((n_times, len(ENERGY_TERMS)), np.nan),
        joint_force=np.zeros((n_times, 0, 3)),
    )


@kernel
def with_room(record, n_joints):
    """The record, grown where it cannot hold so many joints; a new joint has carried nothing so far."""
    n_times, room, _ = record.joint_force.shape
    if n_joints <= room:
        return record
    force = np.zeros((n_times, n_joints + n_joints // 4 + _SPARE_JOINTS, 3))
    force[:, :room] = record.joint_force
    return Record(
        record.position, record.orientation, record.velocity, record.angular_velocity, record.energy, force
    )
