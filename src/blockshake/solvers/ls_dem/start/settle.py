"""The static equilibrium that a stack given face to face starts from, so that nothing thumps: relaxation."""

import numpy as np

from blockshake.dynamics.free_motion import spin_into
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.jit import kernel
from blockshake.solvers.ls_dem.contact.candidates import find_candidates, lists_expired
from blockshake.solvers.ls_dem.contact.contact_forces import clear_loads, contact_forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import Poses

_LOCAL_DAMPING = 0.8  # Cundall's: this part of every out-of-balance force opposes the motion
_MOST_STEPS = 400_000


@kernel
def settle(assembly, given, state, near, at_rest, left, candidates, joints):
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
    at_rest : float64 array, shape (n_bodies,)
        Out-of-balance force below which a body is at rest [N].
    left : bool array, shape (n_bodies,)
        Free bodies known to have no equilibrium; those found to have none are added.
    candidates, joints : Candidates, NearPairs
        Before the first search.

    Returns
    -------
    candidates, joints : Candidates, NearPairs
        Near nodes with the shear springs of the equilibrium, and the pairs they belong to.
    steps : int
        Pseudo steps made.

    Notes
    -----
    Relaxation with the local damping of Cundall (1987): a part of each component of the
    out-of-balance force and moment acts against the velocity. A body that leaves is held where it
    is from then on and its contacts with it, so that the others can settle.
    """
    bodies, surfaces, interfaces = assembly.bodies, assembly.surfaces, assembly.interfaces
    n_bodies, skin, dt = bodies.mass.size, assembly.skin, assembly.dt
    velocity, momentum, spin = np.zeros((n_bodies, 3)), np.zeros((n_bodies, 3)), np.zeros((n_bodies, 3))
    turn = np.empty(3)
    rotation, rotation_before = np.empty((n_bodies, 3, 3)), np.empty((n_bodies, 3, 3))
    for body in range(n_bodies):
        rotation_matrix_into(given.orientation[body], rotation_before[body])
    poses = Poses(state.position, rotation, given.position.copy(), rotation_before)
    loads = no_loads(n_bodies, joints)
    for step in range(_MOST_STEPS):
        for body in range(n_bodies):
            rotation_matrix_into(state.orientation[body], rotation[body])
        if step == 0 or lists_expired(
            candidates, surfaces, bodies.driven, state.position, state.orientation, skin
        ):
            candidates, joints = find_candidates(
                surfaces, bodies.driven, poses, state.orientation, skin, candidates, joints
            )
            loads = no_loads(n_bodies, joints)
        clear_loads(bodies, loads)
        # the way from the given poses stretches springs and is no velocity
        contact_forces_into(candidates, surfaces, interfaces, poses, dt if step > 0 else 0.0, loads)
        poses.position_before[:] = state.position
        poses.rotation_before[:] = rotation
        settled = True
        for body in range(n_bodies):
            if bodies.driven[body] or left[body]:
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
            for axis in range(3):
                turn[axis] = dt * spin[body, axis]
            rotate_into(state.orientation[body], turn, state.orientation[body])
            moved = np.sqrt(((state.position[body] - given.position[body]) ** 2).sum())
            dot = abs((state.orientation[body] * given.orientation[body]).sum())
            if moved + 2.0 * radius * np.sqrt(max(1.0 - dot * dot, 0.0)) > near:
                left[body] = True
                velocity[body], momentum[body], spin[body] = 0.0, 0.0, 0.0
        if settled:
            return candidates, joints, step
    return candidates, joints, _MOST_STEPS
