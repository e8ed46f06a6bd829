"""State of an NSCD run between two steps: enough to stop it there and to go on as if it had not stopped."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import ENERGY_TERMS, State

# Entries of ``clock`` after `STEP` and `NEXT_RECORD` of `blockshake.solvers.status`: sums and counts over the steps
ITERATIONS, MOST_ITERATIONS, BAD_STEPS, CAPPED_STEPS, PARTED_STEPS, N_CLOCK = 2, 3, 4, 5, 6, 7
# Entries of ``audit``: net work taken out so far by friction and by normal impulses, largest misfit of the
# energy terms and largest energy in play [J], largest relative residual [1], deepest penetration [m], length of
# the last step or part of a step [s], energy in soft layers and stops [J]
FRICTION_WORK, NORMAL_WORK, MISFIT, IN_PLAY, WORST_RESIDUAL, DEEPEST, LAST_STEP, HELD, N_AUDIT = range(9)


class Progress(NamedTuple):
    """State of a run between two steps, changed in place by kernels.

    ``state``: at the last step. ``energy``, ``energy_start`` (7,): `ENERGY_TERMS` at the last step and
    at the first [J]. ``face`` int64 (n_bodies, n_bodies): of each pair, as in `detect_pair_into`.
    ``clock`` int64 (N_CLOCK,). ``audit`` (N_AUDIT,).
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
        clock=np.zeros(N_CLOCK, np.int64),
        audit=np.zeros(N_AUDIT),
    )
