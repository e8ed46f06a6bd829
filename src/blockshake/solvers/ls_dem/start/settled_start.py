"""Start of a run: stacks at rest are put into their equilibrium, everything else stays as given."""

import logging

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.geometry.structure import START_TOLERANCE
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates
from blockshake.solvers.ls_dem.contact.packets import HELD, STRETCH
from blockshake.solvers.ls_dem.joints import no_joints
from blockshake.solvers.ls_dem.start.as_laid import joints_as_laid
from blockshake.solvers.ls_dem.start.equilibrium import approach_equilibrium
from blockshake.solvers.ls_dem.start.settle import settle

_log = logging.getLogger(__name__)


def settled_start(structure, assembly, state):
    """Put stacks at rest into their equilibrium, and find what is near and what touches there.

    Where a stack has no equilibrium near, or only one that squeezes it, what its bodies overlap by is taken up
    (`joints_as_laid`), and its equilibrium sought once more.

    Parameters
    ----------
    structure, assembly : Structure, Assembly
    state : State
        As given; the poses of bodies that have an equilibrium near are changed.

    Returns
    -------
    candidates, joints : Candidates, NearPairs
    started : float64 array, shape (3,)
        Settling steps made, largest stable time step [s], and deepest overlap taken up [m].

    Raises
    ------
    InputError
        Bodies that start inside one another.
    """
    settled, *start = _relaxed(structure, assembly, state, no_joints())
    joints, overlap = joints_as_laid(structure, assembly, state, settled)
    if overlap > 0.0:
        settled, *start = _relaxed(structure, assembly, state, joints)
    relaxed, candidates, joints, steps, stable_step = start
    if assembly.dt > stable_step:
        _log.warning(
            "a time step of %g s is above the joints' limit of stability, %.2g s", assembly.dt, stable_step
        )
    state.position[settled] = relaxed.position[settled]
    state.orientation[settled] = relaxed.orientation[settled]
    # what was slipped on the way to the equilibrium is not the run's
    joints.slip[:], joints.slip_rate[:], joints.touched[:] = 0.0, 0.0, False
    for pair, (a, b) in enumerate(candidates.pairs):
        if not (settled[a] or settled[b]):
            first, last = candidates.first[2 * pair], candidates.first[2 * pair + 2]
            candidates.packets[first:last, STRETCH:HELD] = 0.0
    return candidates, joints, np.array([steps, stable_step, overlap])


def _relaxed(structure, assembly, state, joints):
    """Which free bodies have an equilibrium near, the state there, its lists and joints, and how it came about."""
    position, orientation, at_rest, left, stable_step = approach_equilibrium(
        assembly, state, START_TOLERANCE, joints
    )
    relaxed = state._replace(position=position, orientation=orientation)
    candidates = empty_candidates(len(structure.mass))
    candidates, joints, steps = settle(
        assembly, state, relaxed, START_TOLERANCE, at_rest, left, candidates, joints
    )
    free = ~structure.driven
    _, group = connected_components(structure.touching & free[:, None] & free[None, :])
    return free & ~np.isin(group, group[left]), relaxed, candidates, joints, steps, stable_step
