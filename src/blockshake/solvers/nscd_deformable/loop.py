"""The time loop of deformable bodies, compiled whole: predict, find, solve, move, account, record."""

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import place_driven_into
from blockshake.jit import kernel
from blockshake.solvers.external_forces import external_wrenches_into
from blockshake.solvers.ground import ground_at_start, move_ground_by_secant_into, move_ground_into
from blockshake.solvers.nscd.audit import account_into, audit_into, count_into, start_audit, stopper_energy
from blockshake.solvers.nscd.contact.contacts import contact_margin
from blockshake.solvers.nscd.contact.law_shift import bodies_meet
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.joints import press_anew, slip_into, with_pressed
from blockshake.solvers.nscd.loop import find_diverged, least_impulse, record_until_into
from blockshake.solvers.nscd.progress import LAST_STEP
from blockshake.solvers.nscd.recording import record_into
from blockshake.solvers.nscd.step import empty_step, move_into, predict_into
from blockshake.solvers.nscd_deformable.contact_points import find_contacts
from blockshake.solvers.nscd_deformable.contact_step import solve_step
from blockshake.solvers.nscd_deformable.elastic_step import elastic_energy, move_elastic_into, points_into
from blockshake.solvers.nscd_deformable.solve.operator import surface_velocities_into
from blockshake.solvers.record import with_room
from blockshake.solvers.status import COLLAPSED, COMPLETED, DIVERGED, NEXT_RECORD, PAUSED, STEP

_ROUNDING = 1e-9  # of a step, when a record time meets the end of a step


@kernel
def integrate(model, times, pause, progress, deformation, contacts, joints, factor, record):
    """Integrate from where ``progress`` stands to the last record time, to a pause, to collapse or divergence.

    Parameters
    ----------
    model : DeformableScene
    times : float64 array, shape (n_times,)
        When to record, increasing from 0 [s].
    pause : int
        Number of steps made after which to pause.
    progress, deformation : Progress, Deformation
        Changed in place.
    contacts : Contacts
        Of the step before, to start the next one from.
    joints : Joints
    factor : Factor
    record : RunRecord
        Filled from the next record on.

    Returns
    -------
    code, culprit : int
        Of `blockshake.solvers.status`; body that collapsed or ran away, else -1.
    contacts, joints, factor, record : Contacts, Joints, Factor, RunRecord
        To go on with.
    """
    scene, elastic, bodies = model.scene, model.elastic, model.scene.bodies
    settings, state, clock = scene.settings, progress.state, progress.clock
    dt, theta = settings.dt, settings.theta
    step, placed, ground = empty_step(state), empty_placed(scene.polyhedra), ground_at_start(scene.table)
    energy_before = progress.energy.copy()
    gravity = np.linalg.norm(bodies.gravity)
    rate = np.empty(deformation.rate.size)
    if clock[STEP] == 0:
        _start(model, ground, step, placed, deformation, progress)
    n_steps = int(np.ceil(times[times.size - 1] / dt - _ROUNDING))
    if n_steps == 0:
        record_into(bodies, state, state, progress.energy, progress.energy, 0.0, clock[NEXT_RECORD], record)
        clock[NEXT_RECORD] = 1
    while clock[STEP] < n_steps:
        if clock[STEP] == pause:
            return PAUSED, -1, contacts, joints, factor, record
        iterations, residual, part, parts, response = 0, 0.0, 0, 1, model.whole
        while part < parts:
            h, place = dt / parts, clock[STEP] * parts + part
            move_ground_by_secant_into(ground, (place + 1.0 - theta) * h, (place + 2.0 - theta) * h, h)
            if scene.forces.body.size > 0:
                external_wrenches_into(bodies, scene.forces, state, (place + 0.5) * h, 0.5 * h, step.external)
                step.external[:] *= h
            predict_into(bodies, state, ground, h, theta, step)

            margin = contact_margin(step.v_start, scene.polyhedra.radius, bodies.gravity, h)
            floor, share = least_impulse(bodies, gravity, step.v, h), h / progress.audit[LAST_STEP]
            found, anchors, motion, tried, left, factor = solve_step(
                model, response, theta, settings.restitution, margin, joints, progress.face, contacts, share,
                floor, settings.tolerance, deformation, rate, step, placed, factor,
            )  # fmt: skip
            n_contacts = found.gap.size - scene.stoppers.body.size
            iterations += tried
            if parts < settings.impact_parts and bodies_meet(found, n_contacts, step.v_start, gravity * dt):
                parts, response = settings.impact_parts, model.part
                continue
            contacts, residual = found, max(residual, left)

            move_ground_into(ground, (place + 1) * h)
            move_into(bodies, ground, h, theta, contacts, step, state)
            mean = (1.0 - response.theta) * deformation.rate
            lost = move_elastic_into(elastic, response, anchors, motion.forces, rate, deformation)
            mean += response.theta * deformation.rate
            points_into(elastic, mean, anchors, motion.points)
            u_mean = np.empty((contacts.gap.size, 3))
            surface_velocities_into(anchors, step.rotations, contacts, step.v_mean, motion.points, u_mean)
            kinetic, strain = elastic_energy(elastic, deformation)
            energy_before[:] = progress.energy
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
                bodies, ground, step.before, energy_before, contacts, n_contacts, joints, place, h, times, progress,
                record,
            )  # fmt: skip
        count_into(iterations, residual, settings.tolerance, parts, clock, progress.audit)
        clock[STEP] += 1
        fallen = find_collapsed(bodies, state, scene.watch.supported, scene.watch.drop_limit)
        if fallen >= 0:
            return COLLAPSED, fallen, contacts, joints, factor, record
    return COMPLETED, -1, contacts, joints, factor, record


@kernel
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
