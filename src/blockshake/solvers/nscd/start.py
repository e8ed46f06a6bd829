"""The static equilibrium on soft joints that stacks given face to face start from, so that nothing thumps."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotate_into
from blockshake.geometry.structure import START_TOLERANCE
from blockshake.jit import inner_kernel, kernel
from blockshake.solvers.ground import ground_at_start
from blockshake.solvers.nscd.contact.contacts import delassus_into, detect_contacts
from blockshake.solvers.nscd.contact.law import friction_into, law_shift_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.progress import no_joints
from blockshake.solvers.nscd.solve.newton import newton_space
from blockshake.solvers.nscd.solve.solver import solve_contacts_into
from blockshake.solvers.nscd.step import empty_step, predict_into

LONG_STEP = 0.1  # s; what swings faster than 10 rad/s comes to rest by at least half in each
SETTLING_TOLERANCE = 1e-12  # of the contact problem of a long step, below that of a run: it leaves no thump
_MOST_STEPS = 100
_AT_REST = 1e-13  # m, of a step's motion: the rounding of a position
# typed numbers: for literal ones detection and solver would be compiled once more
_MOST_ITERATIONS, _NO_STOPPERS = np.int64(200), np.int64(0)


def settled_state(scene, touching, state):
    """State whose stacks on soft joints rest under gravity; everything else as given.

    Parameters
    ----------
    scene : ContactScene
        The driven bodies have the pitch of the motion's start.
    touching : bool array, shape (n_bodies, n_bodies)
        As in `Structure`, in the solver's order.
    state : State
        Given; velocities are kept.

    Returns
    -------
    State
        Poses as given where no joint of the stack is soft, or a body of it would move by more than 0.1 mm.

    Notes
    -----
    Implicit Euler steps, each from rest and far longer than any period: with the mass next to nothing with
    ``k h^2`` they are Newton's method for the equilibrium, with the contact law of the run.
    """
    joints = no_joints(len(scene.bodies.driven))
    soft = (touching & (scene.layers > 0.0)).any(axis=1)
    return settle_stacks(
        scene, touching, soft, state, lambda _, settled: _static_step(scene, joints, settled), _MOST_STEPS, _AT_REST
    )[0]  # fmt: skip


def settle_stacks(scene, touching, soft, state, static_step, most_steps, at_rest):
    """State whose stacks rest under gravity, by long static steps; everything else as given.

    Parameters
    ----------
    scene, touching, state : ContactScene, bool array, shape (n_bodies, n_bodies), State
        As in `settled_state`.
    soft : bool array, shape (n_bodies,)
        A stack is settled where one of its free bodies is soft.
    static_step : callable
        It takes the bodies that still move, a bool array, and the state, which it changes in place.
    most_steps, at_rest : int, float
        Steps allowed; largest motion in a step that ends the search [m].

    Returns
    -------
    state, moves : State, bool array, shape (n_bodies,)
        Poses as given where a body of the stack would move by more than 0.1 mm, velocities as given; bodies of the
        settled stacks.
    """
    free, radius = ~scene.bodies.driven, scene.polyhedra.radius
    _, group = connected_components(touching & free[:, None] & free[None, :])
    moves = free & np.isin(group, group[soft & free])
    settled = State(*(part.copy() for part in state))
    settled.velocity[:], settled.angular_velocity[:] = 0.0, 0.0
    for _ in range(most_steps):
        if not moves.any():
            break
        before = State(*(part.copy() for part in settled))
        static_step(moves, settled)
        away = largest_motion(settled, state, radius)
        # not (x <= limit), so that NaN counts
        moves &= ~np.isin(group, group[moves & ~(away <= START_TOLERANCE)])
        settled.position[~moves] = state.position[~moves]
        settled.orientation[~moves] = state.orientation[~moves]
        if largest_motion(settled, before, radius).max() < at_rest:
            break
    return settled._replace(velocity=state.velocity, angular_velocity=state.angular_velocity), moves


def largest_motion(state, other, radius):
    """Bound on how far a point of each body is from where it was [m]."""
    # the quaternions of a small turn differ by half of its angle
    turned = 2.0 * radius * np.linalg.norm(state.orientation - other.orientation, axis=1)
    return np.linalg.norm(state.position - other.position, axis=1) + turned


@kernel
def _static_step(scene, joints, state):
    """Move the free bodies by one long implicit step from rest."""
    bodies, polyhedra, dt, theta = scene.bodies, scene.polyhedra, LONG_STEP, 1.0
    step, placed, ground = empty_step(state), empty_placed(polyhedra), ground_at_start(scene.table)
    ground.velocity[:] = 0.0
    predict_into(bodies, state, ground, dt, theta, step)
    place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
    memory = np.full(scene.layers.shape, -1, np.int64)
    contacts = detect_contacts(
        bodies, polyhedra, placed, step.rotations, START_TOLERANCE, scene.settings.shrink, scene.layers,
        theta * dt * dt, memory, _NO_STOPPERS,
    )  # fmt: skip
    delassus_into(bodies, step.inverse_inertia, contacts)
    friction_into(scene.friction, joints, step.rotations, contacts)
    law_shift_into(step, dt, theta, 0.0, contacts)
    floor = 1e-12 * dt * bodies.mass.max() * np.sqrt((bodies.gravity * bodies.gravity).sum()) + 1e-300
    solve_contacts_into(
        bodies, step.inertia, step.inverse_inertia, contacts, floor, SETTLING_TOLERANCE, _MOST_ITERATIONS, step.v,
        newton_space(bodies.driven, contacts.body_a, contacts.body_b),
    )  # fmt: skip
    move_from_rest_into(bodies, step.v, dt, state)


@inner_kernel
def move_from_rest_into(bodies, v, dt, state):
    """Poses after a step with the velocities ``v`` (n_bodies, 6) at its end."""
    turn = np.empty(3)
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            for axis in range(3):
                state.position[body, axis] += dt * v[body, axis]
                turn[axis] = dt * v[body, 3 + axis]
            rotate_into(state.orientation[body], turn, state.orientation[body])
