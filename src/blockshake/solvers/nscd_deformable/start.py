"""The static equilibrium that stacks given face to face start from, so that nothing thumps."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotate_into
from blockshake.geometry.structure import START_TOLERANCE
from blockshake.jit import kernel
from blockshake.solvers.nscd.contact.contacts import empty_contacts
from blockshake.solvers.nscd.contact.polyhedra import empty_placed
from blockshake.solvers.nscd.ground import ground_at_start
from blockshake.solvers.nscd.joints import no_joints
from blockshake.solvers.nscd.start import largest_motion
from blockshake.solvers.nscd.step import empty_step, predict_into
from blockshake.solvers.nscd_deformable.contact_step import solve_step
from blockshake.solvers.nscd_deformable.elastic_bodies import undeformed
from blockshake.solvers.nscd_deformable.elastic_step import move_elastic_into, step_response
from blockshake.solvers.nscd_deformable.solve.newton import no_factor

_LONG_STEP = 0.1  # s; what swings faster than 10 rad/s comes to rest by at least half in each
_MOST_STEPS = 200
_AT_REST = 1e-12  # m, of a step's motion: near the rounding of a position
_TOLERANCE = 1e-12  # of the contact problem of a step, below that of a run: it leaves no thump


def settled_state(model, touching, state):
    """State and deformation of stacks that rest under gravity.

    Parameters
    ----------
    model : Model
        The driven bodies have the pitch of the motion's start.
    touching : bool array, shape (n_bodies, n_bodies)
        As in `Structure`, in the solver's order.
    state : State
        Given; velocities are kept.

    Returns
    -------
    state : State
        Poses as given where a body of the stack would move by more than 0.1 mm.
    deformation : Deformation
        At rest; none where poses are as given.

    Notes
    -----
    Implicit Euler steps, each from rest and far longer than any period, as for soft joints between rigid bodies.
    """
    free, radius = ~model.scene.bodies.driven, model.scene.polyhedra.radius
    _, group = connected_components(touching & free[:, None] & free[None, :])
    moves = free & np.isin(group, group[touching.any(axis=1) & free])
    # without viscosity: at rest it has no say, and would only make the way there longer
    response = step_response(
        model.elastic._replace(damping=np.zeros_like(model.elastic.damping)), _LONG_STEP, 1.0
    )
    settled, deformation = State(*(part.copy() for part in state)), undeformed(model.elastic)
    settled.velocity[:], settled.angular_velocity[:] = 0.0, 0.0
    contacts, factor, joints = empty_contacts(0), no_factor(), no_joints(len(free))
    shapes = np.diff(model.elastic.first_shape)
    for _ in range(_MOST_STEPS):
        if not moves.any():
            break
        before = State(*(part.copy() for part in settled))
        contacts, factor = _static_step(model, response, joints, contacts, factor, deformation, settled)
        away = largest_motion(settled, state, radius)
        # not (x <= limit), so that NaN counts
        moves &= ~np.isin(group, group[moves & ~(away <= START_TOLERANCE)])
        settled.position[~moves], settled.orientation[~moves] = (
            state.position[~moves],
            state.orientation[~moves],
        )
        deformation.amplitude[np.repeat(~moves, shapes)] = 0.0
        if largest_motion(settled, before, radius).max() < _AT_REST:
            break
    return settled._replace(velocity=state.velocity, angular_velocity=state.angular_velocity), deformation


@kernel
def _static_step(model, response, joints, contacts, factor, deformation, state):
    """Move the free bodies, and deform them, by one long implicit step from rest."""
    bodies, scene, dt = model.scene.bodies, model.scene, response.dt
    step, placed, ground = empty_step(state), empty_placed(scene.polyhedra), ground_at_start(scene.table)
    ground.velocity[:] = 0.0
    rate, memory = np.empty(deformation.rate.size), np.full(scene.layers.shape, -1, np.int64)
    deformation.rate[:] = 0.0
    predict_into(bodies, state, ground, dt, 1.0, step)
    floor = 1e-12 * dt * bodies.mass.max() * np.sqrt((bodies.gravity * bodies.gravity).sum()) + 1e-300
    contacts, anchors, motion, _, _, factor = solve_step(
        model, response, 1.0, 0.0, START_TOLERANCE, joints, memory, contacts, 1.0, floor, _TOLERANCE,
        deformation, rate, step, placed, factor,
    )  # fmt: skip
    move_elastic_into(model.elastic, response, anchors, motion.forces, rate, deformation)
    deformation.rate[:] = 0.0
    turn = np.empty(3)
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            for axis in range(3):
                state.position[body, axis] += dt * step.v[body, axis]
                turn[axis] = dt * step.v[body, 3 + axis]
            rotate_into(state.orientation[body], turn, state.orientation[body])
    return contacts, factor
