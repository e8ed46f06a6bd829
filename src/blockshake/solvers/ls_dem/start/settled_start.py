"""Start of a run: stacks at rest are put into their equilibrium, everything else stays as given."""

import logging

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import DEEPEST_OVERLAP, START_TOLERANCE
from blockshake.jit import kernel
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, locate_pair_into
from blockshake.solvers.ls_dem.contact.packets import HELD, LANES, PHI, STRETCH_X
from blockshake.solvers.ls_dem.contact.relative_pose import Poses
from blockshake.solvers.ls_dem.joints import no_joints
from blockshake.solvers.ls_dem.start.equilibrium import approach_equilibrium
from blockshake.solvers.ls_dem.start.settle import settle

_log = logging.getLogger(__name__)


def settled_start(structure, bodies, surfaces, interfaces, skin, time_step, state):
    """Put stacks at rest into their equilibrium, and find what is near and what touches there.

    Parameters
    ----------
    structure, bodies, surfaces, interfaces : Structure, Bodies, Surfaces, Interfaces
    skin, time_step : float
        Reach of the lists [m] and time step [s].
    state : State
        As given; the poses of bodies that have an equilibrium near are changed.

    Returns
    -------
    candidates, joints : Candidates, Joints
    started : float64 array, shape (2,)
        Settling steps made, and largest stable time step [s].

    Raises
    ------
    InputError
        Bodies that start inside one another.
    """
    position, orientation, at_rest, left, stable_step = approach_equilibrium(
        bodies, surfaces, interfaces, skin, state, START_TOLERANCE
    )
    if time_step > stable_step:
        _log.warning(
            "a time step of %g s is above the joints' limit of stability, %.2g s", time_step, stable_step
        )
    relaxed = state._replace(position=position, orientation=orientation)
    candidates, joints, steps = settle(
        bodies, surfaces, interfaces, skin, time_step, state, relaxed, START_TOLERANCE, at_rest, left,
        empty_candidates(len(bodies.mass)), no_joints(),
    )  # fmt: skip
    _check_overlap(structure, candidates, surfaces, relaxed)
    free = ~structure.driven
    _, group = connected_components(structure.touching & free[:, None] & free[None, :])
    settled = free & ~np.isin(group, group[left])
    state.position[settled] = relaxed.position[settled]
    state.orientation[settled] = relaxed.orientation[settled]
    # what was slipped on the way to the equilibrium is not the run's
    joints.slip[:], joints.slip_rate[:], joints.touched[:] = 0.0, 0.0, False
    for pair, (a, b) in enumerate(candidates.pairs):
        if not (settled[a] or settled[b]):
            first, last = candidates.first[2 * pair], candidates.first[2 * pair + 2]
            candidates.packets[first:last, STRETCH_X:HELD] = 0.0
    return candidates, joints, np.array([steps, stable_step])


def _check_overlap(structure, candidates, surfaces, state):
    """Refuse bodies that start inside one another: where one is not convex, the structure's own check is blind."""
    rotation = np.ascontiguousarray(rotation_matrices(state.orientation))
    poses = Poses(state.position, rotation, state.position, rotation)
    # places of a copy, since the springs of the first step count from where they are
    depth = _depth_of_pairs(candidates._replace(packets=candidates.packets.copy()), surfaces, poses)
    if depth.max(initial=0.0) > DEEPEST_OVERLAP:
        a, b = candidates.pairs[depth.argmax()]
        raise InputError(
            structure.source,
            f"bodies.{structure.body_names[b]}.position",
            f"overlaps {structure.body_names[a]} by {1e3 * depth.max():.3g} mm; "
            f"expected at most {1e3 * DEEPEST_OVERLAP:.0f} mm",
        )


@kernel
def _depth_of_pairs(candidates, surfaces, poses):
    """Depth of the deepest node of every pair [m], zero where none is inside."""
    depth = np.zeros(candidates.pairs.shape[0])
    R, d = np.empty((2, 3, 3)), np.empty((2, 3))
    for pair in range(depth.size):
        locate_pair_into(candidates, surfaces, poses, pair, R, d)
        for row in range(candidates.first[2 * pair + 2] - candidates.first[2 * pair]):
            for lane in range(LANES):
                depth[pair] = max(depth[pair], -candidates.located[row, PHI + lane])
    return depth
