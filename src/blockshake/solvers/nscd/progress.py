"""What a step needs of the steps before it: enough to stop a run and to go on as if it had not."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import ENERGY_TERMS, State

# Entries of ``clock``: steps made, next record, then sums and counts over the steps made
STEP, NEXT_RECORD, ITERATIONS, MOST_ITERATIONS, BAD_STEPS, CAPPED_STEPS, PARTED_STEPS = 0, 1, 2, 3, 4, 5, 6
# Entries of ``audit``: net work taken out so far by friction and by normal impulses, largest misfit of the
# energy terms and largest energy in play [J], largest relative residual [1], deepest penetration [m], length of
# the last step or part of a step [s]
FRICTION_WORK, NORMAL_WORK, MISFIT, IN_PLAY, WORST_RESIDUAL, DEEPEST, LAST_STEP = 0, 1, 2, 3, 4, 5, 6


class Progress(NamedTuple):
    """State of a run between two steps, changed in place by kernels.

    ``state``: at the last step. ``energy``, ``energy_start`` (7,): `ENERGY_TERMS` at the last step and
    at the first [J]. ``face`` int64 (n_bodies, n_bodies): of each pair, as in `detect_pair_into`.
    ``clock`` int64 (7,). ``audit`` (7,).
    """

    state: State
    energy: np.ndarray
    energy_start: np.ndarray
    face: np.ndarray
    clock: np.ndarray
    audit: np.ndarray


def start_progress(state):
    """Progress before the first step."""
    n_bodies = len(state.position)
    return Progress(
        state=state,
        energy=np.zeros(len(ENERGY_TERMS)),
        energy_start=np.zeros(len(ENERGY_TERMS)),
        face=np.full((n_bodies, n_bodies), -1, np.int64),
        clock=np.zeros(7, np.int64),
        audit=np.zeros(7),
    )
