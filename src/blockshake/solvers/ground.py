"""Motion of the driven bodies during a run."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.motion import PITCH, MotionTable, find_segment, ground_state_into
from blockshake.jit import inner_kernel, kernel_without_allocation


class Ground(NamedTuple):
    """Ground motion at the time last requested.

    ``table`` (MotionTable). ``origin`` (4,): what counts as no displacement [m, rad]. ``displacement``,
    ``velocity`` (4,): x, y, z and pitch since ``origin`` [m, rad], and their rates. ``segment`` int64 (1,): of
    the table, where the next search starts.
    """

    table: MotionTable
    origin: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    segment: np.ndarray


@inner_kernel
def ground_at_start(table):
    """Ground at time zero, from where its displacement counts; its pitch is absolute."""
    ground = Ground(table, np.zeros(4), np.empty(4), np.empty(4), np.zeros(1, np.int64))
    move_ground_into(ground, 0.0)
    for channel in range(PITCH):
        ground.origin[channel], ground.displacement[channel] = ground.displacement[channel], 0.0
    return ground


@kernel_without_allocation
def move_ground_into(ground, t):
    """Displacement and its rate at one time."""
    segment = find_segment(ground.table.breaks, t, ground.segment[0])
    ground_state_into(ground.table, segment, t, ground.displacement, ground.velocity)
    for channel in range(4):
        ground.displacement[channel] -= ground.origin[channel]
    ground.segment[0] = segment


@kernel_without_allocation
def move_ground_by_secant_into(ground, t, later, dt):
    """Displacement at the time ``t``, and the mean velocity from there to ``later``, which is ``dt`` after it."""
    move_ground_into(ground, t)
    at = ground.displacement
    now = at[0], at[1], at[2], at[3]
    move_ground_into(ground, later)
    for channel in range(4):
        ground.velocity[channel] = (at[channel] - now[channel]) / dt
        at[channel] = now[channel]
