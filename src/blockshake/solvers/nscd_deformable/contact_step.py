"""The contacts of one step and their impulses: find, state their law, solve."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.nscd.contact.friction import friction_into
from blockshake.solvers.nscd.contact.law_shift import law_shift_into
from blockshake.solvers.nscd.contact.polyhedra import place_into
from blockshake.solvers.nscd.contact.stoppers import place_stoppers_into
from blockshake.solvers.nscd.contact.warm_start import warm_start_into
from blockshake.solvers.nscd_deformable.contact_points import deform_gaps_into, find_contacts, tangents_into
from blockshake.solvers.nscd_deformable.elastic_step import points_into, predict_elastic_into
from blockshake.solvers.nscd_deformable.solve.operator import Problem, empty_motion
from blockshake.solvers.nscd_deformable.solve.solver import solve_contacts_into


@kernel
def solve_step(
    model, response, theta, restitution, margin, joints, memory, contacts_before, share, floor, tolerance,
    deformation, rate, step, placed, factor,
):  # fmt: skip
    """Contacts of a step whose free motion is predicted, with the impulses that satisfy their law.

    Parameters
    ----------
    model : DeformableScene
    response : ElasticResponse
        Over this step.
    theta, restitution : float
        Of the rigid motion; Newton's.
    margin : float
        Points with a larger gap are left out [m].
    joints : Joints
    memory : int64 array, shape (n_bodies, n_bodies)
        Reference faces of the pairs.
    contacts_before : Contacts
        Of the step before.
    share : float
        Length of this step over that of the one before [1].
    floor : float
        Impulse below which impulses count as that [N s].
    tolerance : float
    deformation : Deformation
        At the start of the step.
    rate : float64 array, shape (n_shapes,)
        Overwritten with the rates at the end of the step without contact.
    step : Step
        After `predict_into`; ``v`` is overwritten with the velocities at the end of the step.
    placed : Placed
        Work space.
    factor : Factor
        Kept from an earlier step.

    Returns
    -------
    contacts, anchors, motion : Contacts, Anchors, ContactMotion
    iterations : int
    residual : float
    factor : Factor
    """
    scene, elastic = model.scene, model.elastic
    bodies, dt = scene.bodies, response.dt
    place_into(scene.polyhedra, step.detection.position, step.detection.orientation, placed)
    contacts, anchors = find_contacts(
        bodies, elastic, scene.polyhedra, placed, step.rotations, margin, model.spacing, scene.layers,
        theta * dt * dt, memory, scene.stoppers.body.size,
    )  # fmt: skip
    place_stoppers_into(bodies, scene.stoppers, scene.watch.base, step, dt, theta, contacts)
    tangents_into(step.rotations, contacts)
    motion = empty_motion(bodies.mass.size, elastic.first_point[bodies.mass.size], contacts.gap.size)
    amplitude = np.empty(rate.size)
    predict_elastic_into(elastic, response, deformation, amplitude, rate)
    points_into(elastic, amplitude, anchors, motion.points)
    deform_gaps_into(anchors, step.rotations, motion.points, contacts)
    point_free = np.zeros(motion.points.shape)
    points_into(elastic, rate, anchors, point_free)
    friction_into(scene.friction, joints, step.rotations, contacts)
    law_shift_into(step, dt, theta, restitution, contacts)
    warm_start_into(contacts_before, scene.polyhedra.radius, share, contacts)
    problem = Problem(
        bodies, elastic, response, anchors, step.inverse_inertia, step.rotations, step.v.copy(), point_free
    )
    iterations, residual, factor = solve_contacts_into(
        problem, contacts, floor, tolerance, scene.settings.max_iterations, motion, factor
    )
    step.v[:] = motion.v
    return contacts, anchors, motion, iterations, residual, factor
