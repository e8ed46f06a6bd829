"""The static equilibrium on soft joints that stacks given face to face start from, so that nothing thumps."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotate_into
from blockshake.jit import kernel
from blockshake.solvers.nscd.contacts import detect_contacts, prepare_operators_into
from blockshake.solvers.nscd.friction import friction_into
from blockshake.solvers.nscd.joints import no_joints
from blockshake.solvers.nscd.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.solver import solve_contacts_into
from blockshake.solvers.nscd.step import bounds_into, empty_step, predict_into

_NEAR = 1e-4  # m, contract: an equilibrium farther than this from the given poses is not the start
_LONG_STEP = 0.1  # s; what swings faster than 10 rad/s comes to rest by at least half in each
_MOST_STEPS = 100
_AT_REST = 1e-13  # m, of a step's motion: the rounding of a position
_TOLERANCE = 1e-12  # of the contact problem of a step, below that of a run: it leaves no thump
_MOST_ITERATIONS = 200


def settled_state(bodies, friction, polyhedra, layers, touching, ground, shrink, state):
    """State whose stacks on soft joints rest under gravity; everything else as given.

    Parameters
    ----------
    bodies, friction, polyhedra : Bodies, Friction, Polyhedra
    layers : float64 array, shape (n_bodies, n_bodies)
        Compliance of the layers in the joints [m3/N].
    touching : bool array, shape (n_bodies, n_bodies)
        As in `Structure`, in the solver's order.
    ground : MotionTable
        The driven bodies have the pitch of its start.
    shrink : float
        As in `NscdParameters`.
    state : State
        Given; velocities are kept.

    Returns
    -------
    State
        Poses as given where no joint of the stack is soft, or a body of it would move by more than 0.1 mm.

    Notes
    -----
    Implicit Euler steps, each from rest and far longer than any period: with the mass next to nothing beside
    ``k h^2`` they are Newton's method for the equilibrium, with the contact law of the run.
    """
    free = ~bodies.driven
    _, group = connected_components(touching & free[:, None] & free[None, :])
    soft = (touching & (layers > 0.0)).any(axis=1) & free
    moves = free & np.isin(group, group[soft])
    placed_ground = np.array([0.0, 0.0, 0.0, ground.coefficients[0, 3, 0]])
    joints = no_joints(len(free))
    settled = State(*(part.copy() for part in state))
    settled.velocity[:], settled.angular_velocity[:] = 0.0, 0.0
    for _ in range(_MOST_STEPS):
        if not moves.any():
            break
        before = State(*(part.copy() for part in settled))
        _static_step(bodies, friction, polyhedra, layers, joints, placed_ground, shrink, settled)
        away = _motion(settled, state, polyhedra.radius)
        # not (x <= limit), so that NaN counts
        moves &= ~np.isin(group, group[moves & ~(away <= _NEAR)])
        settled.position[~moves], settled.orientation[~moves] = (
            state.position[~moves],
            state.orientation[~moves],
        )
        if _motion(settled, before, polyhedra.radius).max() < _AT_REST:
            break
    return settled._replace(velocity=state.velocity, angular_velocity=state.angular_velocity)


def _motion(state, other, radius):
    """Bound on how far a point of each body is from where it was [m]."""
    # the quaternions of a small turn differ by half of its angle
    turned = 2.0 * radius * np.linalg.norm(state.orientation - other.orientation, axis=1)
    return np.linalg.norm(state.position - other.position, axis=1) + turned


@kernel
def _static_step(bodies, friction, polyhedra, layers, joints, ground, shrink, state):
    """Move the free bodies by one long implicit step from rest."""
    dt, theta, n_bodies = _LONG_STEP, 1.0, bodies.mass.size
    step, placed, rest = empty_step(state), empty_placed(polyhedra), np.zeros(4)
    predict_into(bodies, state, ground, rest, dt, theta, step)
    place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
    memory = np.full((n_bodies, n_bodies), -1, np.int64)
    contacts = detect_contacts(
        bodies, polyhedra, placed, step.rotations, _NEAR, shrink, layers, theta * dt * dt, memory, 0
    )
    prepare_operators_into(bodies, step.inverse_inertia, contacts)
    friction_into(friction, joints, step.rotations, contacts)
    bounds_into(step, dt, theta, 0.0, contacts)
    floor = 1e-12 * dt * bodies.mass.max() * np.sqrt((bodies.gravity * bodies.gravity).sum()) + 1e-300
    solve_contacts_into(
        bodies, step.inertia, step.inverse_inertia, contacts, floor, _TOLERANCE, _MOST_ITERATIONS, step.v
    )
    turn = np.empty(3)
    for body in range(n_bodies):
        if not bodies.driven[body]:
            for axis in range(3):
                state.position[body, axis] += dt * step.v[body, axis]
                turn[axis] = dt * step.v[body, 3 + axis]
            rotate_into(state.orientation[body], turn, state.orientation[body])
