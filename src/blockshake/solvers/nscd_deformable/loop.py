"""The time loop of deformable bodies, compiled whole: predict, find, solve, move, account, record."""

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import place_driven_into
from blockshake.geometry.vectors import copy_into, dot
from blockshake.jit import inner_kernel, kernel
from blockshake.solvers.external_forces import external_impulses_into, number_of
from blockshake.solvers.ground import ground_at_start, move_ground_by_secant_into, move_ground_into
from blockshake.solvers.nscd.audit import account_into, audit_into, count_into, start_audit, stopper_energy
from blockshake.solvers.nscd.contact.contacts import contact_margin, place_stoppers_into
from blockshake.solvers.nscd.contact.law import bodies_meet, friction_into, law_shift_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.contact.warm_start import warm_start_into
from blockshake.solvers.nscd.loop import ROUNDING, least_impulse, record_until_into
from blockshake.solvers.nscd.progress import LAST_STEP, press_anew, slip_into, with_pressed
from blockshake.solvers.nscd.recording import record_into
from blockshake.solvers.nscd.step import empty_step, move_into, predict_into
from blockshake.solvers.nscd_deformable.contact_points import deform_gaps_into, find_contacts, tangents_into
from blockshake.solvers.nscd_deformable.elastic_step import (
    at_anchors,
    elastic_energy,
    move_elastic_into,
    points_into,
    predict_elastic_into,
)
from blockshake.solvers.nscd_deformable.solve.operator import Problem, empty_motion, surface_velocities_into
from blockshake.solvers.nscd_deformable.solve.solver import solve_contacts_into
from blockshake.solvers.record import (
    COLLAPSED,
    COMPLETED,
    DIVERGED,
    NEXT_RECORD,
    PAUSED,
    STEP,
    find_diverged,
    with_room,
)


@kernel
def integrate(model, times, pause, progress, deformation, contacts, joints, factor, record):
    """Integrate deformable bodies, as `blockshake.solvers.nscd.loop.integrate` does rigid ones.

    ``model`` (DeformableScene) takes the place of the scene. ``deformation`` (Deformation) is changed in place;
    ``factor`` (Factor) is kept from step to step, and returned with the contacts, joints and record to go on with.
    """
    scene, elastic, bodies = model.scene, model.elastic, model.scene.bodies
    settings, state, clock = scene.settings, progress.state, progress.clock
    dt, theta = settings.dt, settings.theta
    step, placed, ground = empty_step(state), empty_placed(scene.polyhedra), ground_at_start(scene.table)
    energy_before = progress.energy.copy()
    gravity = np.sqrt(dot(bodies.gravity, bodies.gravity))
    rate = np.empty(deformation.rate.size)
    if clock[STEP] == 0:
        _start(model, ground, step, placed, deformation, progress)
    n_steps = int(np.ceil(times[times.size - 1] / dt - ROUNDING))
    if n_steps == 0:
        record_into(bodies, state, state, progress.energy, progress.energy, 0.0, clock[NEXT_RECORD], record)
        clock[NEXT_RECORD] = 1
    while clock[STEP] < n_steps:
        if clock[STEP] == pause:
            return PAUSED, -1, contacts, joints, factor, record
        iterations, residual, part, parts, response = 0, 0.0, 0, 1, model.whole
        while part < parts:
            h, number = dt / parts, clock[STEP] * parts + part
            move_ground_by_secant_into(ground, (number + 1.0 - theta) * h, (number + 2.0 - theta) * h, h)
            external_impulses_into(bodies, scene.forces, state, (number + 0.5) * h, h, step.external)
            predict_into(bodies, state, ground, h, theta, step)

            margin = contact_margin(step.v_start, scene.polyhedra.radius, bodies.gravity, h)
            floor, share = least_impulse(bodies, gravity, step.v, h), h / progress.audit[LAST_STEP]
            renewed, anchors, motion, tried, error, factor = solve_step(
                model, response, theta, settings.restitution, margin, joints, progress.face, contacts, share,
                floor, settings.tolerance, deformation, rate, step, placed, factor,
            )  # fmt: skip
            n_contacts = renewed.gap.size - number_of(scene.stoppers)
            iterations += tried
            if parts < settings.impact_parts and bodies_meet(renewed, n_contacts, step.v_start, gravity * dt):
                parts, response = settings.impact_parts, model.part
                continue
            contacts, residual = renewed, max(residual, error)

            move_ground_into(ground, (number + 1) * h)
            move_into(bodies, ground, h, theta, contacts, step, state)
            mean = (1.0 - response.theta) * deformation.rate
            lost = move_elastic_into(elastic, response, anchors, motion.forces, rate, deformation)
            mean += response.theta * deformation.rate
            points_into(elastic, mean, anchors, motion.points)
            u_mean = np.empty((contacts.gap.size, 3))
            surface_velocities_into(anchors, step.rotations, contacts, step.v_mean, motion.points, u_mean)
            kinetic, strain = elastic_energy(elastic, deformation)
            copy_into(progress.energy, energy_before)
            squeezed = stopper_energy(bodies, scene.stoppers, scene.watch.base, state)
            account_into(bodies, contacts, u_mean, step, theta, squeezed, (kinetic, strain, lost), progress)
            audit_into(contacts, n_contacts, progress)
            if press_anew(joints, contacts, n_contacts):
                joints = with_pressed(joints, contacts, n_contacts)
                record = with_room(record, joints.slip.size)
            slip_into(contacts, n_contacts, motion.u, h, theta, joints)
            progress.audit[LAST_STEP] = h
            part += 1

            runaway = find_diverged(state)
            if runaway >= 0:
                clock[STEP] += 1
                return DIVERGED, runaway, contacts, joints, factor, record
            record_until_into(
                bodies, ground, step.before, energy_before, contacts, n_contacts, joints, number, h, times, progress,
                record,
            )  # fmt: skip
        count_into(iterations, residual, settings.tolerance, parts, clock, progress.audit)
        clock[STEP] += 1
        fallen = find_collapsed(bodies, state, scene.watch.supported, scene.watch.drop_limit)
        if fallen >= 0:
            return COLLAPSED, fallen, contacts, joints, factor, record
    return COMPLETED, -1, contacts, joints, factor, record


@inner_kernel
def _start(model, ground, step, placed, deformation, progress):
    """Driven bodies where the motion has them at time zero, and the energy that the run starts with."""
    scene, state = model.scene, progress.state
    dt, theta = scene.settings.dt, scene.settings.theta
    # a typed zero: for a literal one the whole detection would be compiled once more
    no_stoppers = np.int64(0)
    place_driven_into(scene.bodies, ground.displacement, ground.velocity, state)
    place_into(scene.polyhedra, state.position, state.orientation, placed)
    predict_into(scene.bodies, state, ground, 0.0, theta, step)
    at_start, _ = find_contacts(
        scene.bodies, model.elastic, scene.polyhedra, placed, step.rotations, 0.0, model.spacing, scene.layers,
        theta * dt * dt, progress.face.copy(), no_stoppers,
    )  # fmt: skip
    _, strain = elastic_energy(model.elastic, deformation)
    start_audit(scene.bodies, at_start, dt, theta, strain, progress)


@inner_kernel
def solve_step(
    model, response, theta, restitution, margin, joints, memory, contacts_before, share, floor, tolerance,
    deformation, rate, step, placed, factor,
):  # fmt: skip
    """Contacts of a step whose free motion is predicted, with the impulses that satisfy their law.

    Parameters
    ----------
    model, response : DeformableScene, ElasticResponse
        The response is that over this step.
    theta, restitution : float
        Weight of the end of a step, rigid motion; Newton's coefficient.
    margin : float
        Points with a larger gap are left out [m].
    joints, memory : Joints, int64 array, shape (n_bodies, n_bodies)
        The memory holds the reference faces of the pairs.
    contacts_before, share : Contacts, float
        Contacts of the step before; length of this step over that of the one before [1].
    floor, tolerance : float
        Impulse below which impulses count as that [N s]; relative residual that ends the search [1].
    deformation, rate : Deformation, float64 array, shape (n_shapes,)
        At the start of the step; overwritten with the rates at its end without contact.
    step, placed : Step, Placed
        After `predict_into`, its ``v`` is overwritten with the velocities at the end of the step; work space.
    factor : Factor
        Kept from an earlier step.

    Returns
    -------
    contacts, anchors, motion, iterations, residual, factor
        Contacts, Anchors and ContactMotion of the answer; the rest is that of `solve_contacts_into`.
    """
    scene, elastic = model.scene, model.elastic
    bodies, dt = scene.bodies, response.dt
    place_into(scene.polyhedra, step.detection.position, step.detection.orientation, placed)
    contacts, anchors = find_contacts(
        bodies, elastic, scene.polyhedra, placed, step.rotations, margin, model.spacing, scene.layers,
        theta * dt * dt, memory, number_of(scene.stoppers),
    )  # fmt: skip
    place_stoppers_into(bodies, scene.stoppers, scene.watch.base, step, dt, theta, contacts)
    tangents_into(step.rotations, contacts)
    motion = empty_motion(bodies.mass.size, anchors.active.size, contacts.gap.size)
    amplitude = np.empty(rate.size)
    predict_elastic_into(elastic, response, deformation, amplitude, rate)
    points_into(elastic, amplitude, anchors, motion.points)
    deform_gaps_into(anchors, step.rotations, motion.points, contacts)
    point_free = np.empty(motion.points.shape)
    points_into(elastic, rate, anchors, point_free)
    friction_into(scene.friction, joints, step.rotations, contacts)
    law_shift_into(step, dt, theta, restitution, contacts)
    warm_start_into(contacts_before, scene.polyhedra.radius, share, contacts)
    problem = Problem(
        bodies, at_anchors(elastic, response, anchors), anchors, step.inverse_inertia, step.rotations, step.v.copy(),
        point_free,
    )  # fmt: skip
    iterations, residual, factor = solve_contacts_into(
        problem, contacts, floor, tolerance, scene.settings.max_iterations, motion, factor
    )
    copy_into(motion.v, step.v)
    return contacts, anchors, motion, iterations, residual, factor
