"""Start of a run: stacks at rest are relaxed into their equilibrium, so that nothing thumps."""

import logging

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.free_motion import spin_into
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.geometry.structure import START_TOLERANCE
from blockshake.geometry.vectors import difference, dot
from blockshake.jit import loop_kernel
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates, lists_expired
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.packets import STRETCH
from blockshake.solvers.ls_dem.contact.relative_pose import keep_poses, poses_at_rest
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.start.as_laid import joints_as_laid
from blockshake.solvers.ls_dem.start.equilibrium import approach_equilibrium

_log = logging.getLogger(__name__)
_LOCAL_DAMPING = 0.8  # Cundall's: this part of every out-of-balance force opposes the motion
_MOST_STEPS = 400_000


def settled_start(structure, assembly, state):
    """Put stacks at rest into their equilibrium, and find what is near and what touches there.

    Where a stack has no equilibrium near, or only one that squeezes it, what its bodies overlap by is taken up
    (`joints_as_laid`), and its equilibrium sought once more. Of ``state`` the poses of bodies that have an equilibrium
    near are changed.

    Returns
    -------
    candidates, joints, started : Candidates, NearPairs, float64 array, shape (3,)
        The last: settling steps made, largest stable time step [s], and deepest overlap taken up [m].

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
            candidates.packets.kept[first:last, STRETCH:] = 0.0
    return candidates, joints, np.array([steps, stable_step, overlap])


def _relaxed(structure, assembly, state, joints):
    """Which free bodies have an equilibrium near, the state there, its lists and joints, and how it came about."""
    position, orientation, at_rest, leaving, stable_step = approach_equilibrium(
        assembly, state, START_TOLERANCE, joints
    )
    relaxed = state._replace(position=position, orientation=orientation)
    candidates = empty_candidates(len(structure.mass))
    candidates, joints, steps = settle(
        assembly, state, relaxed, START_TOLERANCE, at_rest, leaving, candidates, joints
    )
    free = ~structure.driven
    _, group = connected_components(structure.touching & free[:, None] & free[None, :])
    return free & ~np.isin(group, group[leaving]), relaxed, candidates, joints, steps, stable_step


def settle(assembly, given, state, near, at_rest, leaving, candidates, joints):
    """Find the equilibrium under gravity near the given poses by dynamic relaxation.

    Parameters
    ----------
    assembly : Assembly
        Its time step is that of the relaxation.
    given, state : State
        Poses from where motion counts, and poses to start from, which are moved to the equilibrium;
        velocities do not enter.
    near : float
        A body that moves farther than this from its given pose has no equilibrium [m].
    at_rest, leaving : float64 and bool arrays, shape (n_bodies,)
        Out-of-balance force below which a body is at rest [N]; free bodies known to have no equilibrium, to which those
        met here are added.
    candidates, joints : Candidates, NearPairs
        Before the first search.

    Returns
    -------
    candidates, joints, steps : Candidates, NearPairs, int
        Near nodes with the shear springs of the equilibrium, the pairs they belong to, and pseudo steps made.

    Notes
    -----
    Relaxation with the local damping of Cundall (1987): a part of each component of the
    out-of-balance force and moment acts against the velocity. A body that leaves is held where it
    is from then on and its contacts with it, so that the others can settle.
    """
    bodies, surfaces, interfaces = assembly.bodies, assembly.surfaces, assembly.interfaces
    n_bodies, dt = len(bodies.mass), assembly.dt
    rotation, rotation_before = np.empty((2, n_bodies, 3, 3))
    for body in range(n_bodies):
        rotation_matrix_into(given.orientation[body], rotation_before[body])
        rotation_matrix_into(state.orientation[body], rotation[body])
    poses = poses_at_rest(given.position, rotation_before)._replace(
        position=state.position, rotation=rotation
    )
    motion, expired = np.zeros((3, n_bodies, 3)), True
    for step in range(_MOST_STEPS):
        if expired:
            candidates, joints = find_candidates(
                surfaces, bodies.driven, poses, state.orientation, assembly.skin, candidates, joints
            )
            loads = no_loads(n_bodies, joints)
        # the way from the given poses stretches springs and is no velocity
        forces_into(bodies, candidates, surfaces, interfaces, poses, dt if step > 0 else 0.0, loads)
        settled, expired = _relax(
            assembly, given, near, at_rest, candidates, loads, state, poses, motion, leaving
        )
        if settled:
            return candidates, joints, step
    return candidates, joints, _MOST_STEPS


@loop_kernel
def _relax(assembly, given, near, at_rest, candidates, loads, state, poses, motion, leaving):
    """One pseudo step of `settle`: whether all bodies were at rest before it, and whether the lists have expired.

    ``motion`` (3, n_bodies, 3): velocity, angular momentum and spin; with poses, state and ``leaving`` changed.
    """
    bodies, surfaces, dt = assembly.bodies, assembly.surfaces, assembly.dt
    velocity, momentum, spin = motion[0], motion[1], motion[2]
    keep_poses(poses)
    settled = True
    for body in range(bodies.mass.size):
        if bodies.driven[body] or leaving[body]:
            continue
        radius = surfaces.radius[body]
        for axis in range(3):
            force, moment = loads.force[body, axis], loads.moment[body, axis]
            if not (abs(force) < at_rest[body] and abs(moment) < at_rest[body] * radius):
                settled = False
            force -= _LOCAL_DAMPING * abs(force) * np.sign(velocity[body, axis])
            moment -= _LOCAL_DAMPING * abs(moment) * np.sign(momentum[body, axis])
            velocity[body, axis] += dt * bodies.inverse_mass[body] * force
            momentum[body, axis] += dt * moment
            state.position[body, axis] += dt * velocity[body, axis]
        spin_into(bodies.inverse_inertia[body], state.orientation[body], momentum[body], spin[body])
        turn = dt * spin[body, 0], dt * spin[body, 1], dt * spin[body, 2]
        rotate_into(state.orientation[body], turn, state.orientation[body])
        away = difference(state.position[body], given.position[body])
        cosine = 0.0
        for part in range(4):
            cosine += state.orientation[body, part] * given.orientation[body, part]
        if np.sqrt(dot(away, away)) + 2.0 * radius * np.sqrt(max(1.0 - cosine * cosine, 0.0)) > near:
            leaving[body] = True
            for axis in range(3):
                velocity[body, axis], momentum[body, axis], spin[body, axis] = 0.0, 0.0, 0.0
    for body in range(bodies.mass.size):
        rotation_matrix_into(state.orientation[body], poses.rotation[body])
    return settled, lists_expired(
        candidates, surfaces, bodies.driven, state.position, state.orientation, assembly.skin
    )
