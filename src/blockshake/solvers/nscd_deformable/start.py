"""The static equilibrium that stacks given face to face start from, so that nothing thumps."""

import numpy as np

from blockshake.geometry.structure import START_TOLERANCE
from blockshake.jit import kernel
from blockshake.solvers.ground import ground_at_start
from blockshake.solvers.nscd.contact.contacts import empty_contacts
from blockshake.solvers.nscd.contact.polyhedra import empty_placed
from blockshake.solvers.nscd.progress import no_joints
from blockshake.solvers.nscd.start import LONG_STEP, SETTLING_TOLERANCE, move_from_rest_into, settle_stacks
from blockshake.solvers.nscd.step import empty_step, predict_into
from blockshake.solvers.nscd_deformable.elastic_bodies import undeformed
from blockshake.solvers.nscd_deformable.elastic_step import move_elastic_into, step_response
from blockshake.solvers.nscd_deformable.loop import solve_step
from blockshake.solvers.nscd_deformable.solve.newton import no_factor

_MOST_STEPS = 200
_AT_REST = 1e-12  # m, of a step's motion: near the rounding of a position


def settled_state(model, touching, state):
    """State and deformation of stacks that rest under gravity, by implicit Euler steps as in `settle_stacks`.

    Parameters
    ----------
    model : DeformableScene
        The driven bodies have the pitch of the motion's start.
    touching, state : bool array, shape (n_bodies, n_bodies), State

    Returns
    -------
    state, deformation : State, Deformation
        Poses as given and no deformation where a body of the stack would move by more than 0.1 mm.
    """
    # without viscosity: at rest it has no say, and would only make the way there longer
    response = step_response(
        model.elastic._replace(damping=np.zeros_like(model.elastic.damping)), LONG_STEP, 1.0
    )
    deformation, shapes = undeformed(model.elastic), np.diff(model.elastic.first_shape)
    contacts, factor, joints = empty_contacts(0), no_factor(), no_joints(len(touching))

    def static_step(moves, settled):
        nonlocal contacts, factor
        deformation.amplitude[np.repeat(~moves, shapes)] = 0.0
        contacts, factor = _static_step(model, response, joints, contacts, factor, deformation, settled)

    settled, moves = settle_stacks(
        model.scene, touching, touching.any(axis=1), state, static_step, _MOST_STEPS, _AT_REST
    )
    deformation.amplitude[np.repeat(~moves, shapes)] = 0.0
    return settled, deformation


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
        model, response, 1.0, 0.0, START_TOLERANCE, joints, memory, contacts, 1.0, floor, SETTLING_TOLERANCE,
        deformation, rate, step, placed, factor,
    )  # fmt: skip
    move_elastic_into(model.elastic, response, anchors, motion.forces, rate, deformation)
    deformation.rate[:] = 0.0
    move_from_rest_into(bodies, step.v, dt, state)
    return contacts, factor
