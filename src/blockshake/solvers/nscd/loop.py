"""The time loop of nonsmooth contact dynamics, compiled whole: predict, detect, solve, move, account, record."""

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import place_driven_into
from blockshake.geometry.vectors import copy_into, dot
from blockshake.jit import inner_kernel, kernel, kernel_without_allocation
from blockshake.solvers.external_forces import external_impulses_into, number_of
from blockshake.solvers.ground import ground_at_start, move_ground_by_secant_into, move_ground_into
from blockshake.solvers.nscd.audit import account_into, audit_into, count_into, start_audit, stopper_energy
from blockshake.solvers.nscd.contact.contacts import (
    contact_margin,
    contact_velocities_into,
    delassus_into,
    detect_contacts,
    place_stoppers_into,
)
from blockshake.solvers.nscd.contact.law import bodies_meet, friction_into, law_shift_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.contact.warm_start import warm_start_into
from blockshake.solvers.nscd.progress import LAST_STEP, press_anew, slip_into, with_pressed
from blockshake.solvers.nscd.recording import record_driven_into, record_forces_into, record_into
from blockshake.solvers.nscd.solve.newton import joins, newton_space
from blockshake.solvers.nscd.solve.solver import solve_contacts_into
from blockshake.solvers.nscd.step import empty_step, move_into, predict_into
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

ROUNDING = 1e-9  # of a step, when a record time meets the end of a step


@kernel
def integrate(scene, times, pause, progress, contacts, joints, record):
    """Integrate from where ``progress`` stands to the last record time, to a pause, to collapse or divergence.

    Parameters
    ----------
    scene, times : ContactScene, float64 array, shape (n_times,)
        When to record, increasing from 0 [s].
    pause : int
        Number of steps made after which to pause.
    progress, contacts, joints, record : Progress, Contacts, Joints, RunRecord
        The progress is changed in place; contacts of the step before, to start the next one from; the record is filled
        from the next row on.

    Returns
    -------
    code, culprit : int
        `blockshake.solvers.record`; body that collapsed or ran away, else -1.
    contacts, joints, record
        To go on with.

    Notes
    -----
    A step in which bodies meet is taken again in parts, each like a step of its own (``impact_parts``).
    """
    # taken out here: in the loop, each taking out would count the holders of all arrays in it
    bodies, friction, stoppers, forces, layers, polyhedra, _, settings, watch = scene
    state, clock, audit, energy = progress.state, progress.clock, progress.audit, progress.energy
    dt, theta = settings.dt, settings.theta
    step, placed, ground = empty_step(state), empty_placed(polyhedra), ground_at_start(scene.table)
    newton = newton_space(bodies.driven, contacts.body_a, contacts.body_b)
    energy_before = energy.copy()
    gravity = np.sqrt(dot(bodies.gravity, bodies.gravity))
    if clock[STEP] == 0:
        _start(scene, ground, step, placed, progress)
    n_steps = int(np.ceil(times[times.size - 1] / dt - ROUNDING))
    if n_steps == 0:
        record_into(bodies, state, state, energy, energy, 0.0, clock[NEXT_RECORD], record)
        clock[NEXT_RECORD] = 1
    while clock[STEP] < n_steps:
        if clock[STEP] == pause:
            return PAUSED, -1, contacts, joints, record
        iterations, residual, part, parts = 0, 0.0, 0, 1
        while part < parts:
            # predict: poses at t + (1 - theta) dt, where contacts are detected (Moreau 1988; Jean 1999)
            h, number = dt / parts, clock[STEP] * parts + part
            move_ground_by_secant_into(ground, (number + 1.0 - theta) * h, (number + 2.0 - theta) * h, h)
            external_impulses_into(bodies, forces, state, (number + 0.5) * h, h, step.external)
            predict_into(bodies, state, ground, h, theta, step)

            renewed = _detect(
                bodies, stoppers, layers, polyhedra, settings, watch.base, step, placed, progress.face, h
            )
            # laws of the contacts, first guesses from the step before, and the solution of all together
            n_contacts = renewed.gap.size - number_of(stoppers)
            friction_into(friction, joints, step.rotations, renewed)
            law_shift_into(step, h, theta, settings.restitution, renewed)
            warm_start_into(contacts, polyhedra.radius, h / audit[LAST_STEP], renewed)
            if not joins(newton, renewed.body_a, renewed.body_b):
                newton = newton_space(bodies.driven, renewed.body_a, renewed.body_b)
            tried, error = solve_contacts_into(
                bodies, step.inertia, step.inverse_inertia, renewed, least_impulse(bodies, gravity, step.v, h),
                settings.tolerance, settings.max_iterations, step.v, newton,
            )  # fmt: skip
            iterations += tried
            if parts < settings.impact_parts and bodies_meet(renewed, n_contacts, step.v_start, gravity * dt):
                # an impact: nothing has moved yet, so the step begins again in smaller parts
                parts = settings.impact_parts
                continue
            contacts, residual = renewed, max(residual, error)

            # move, then the balance of energy, with the mean velocities that did the work
            move_ground_into(ground, (number + 1) * h)
            move_into(bodies, ground, h, theta, contacts, step, state)
            copy_into(energy, energy_before)
            squeezed = stopper_energy(bodies, stoppers, watch.base, state)
            u = np.empty((contacts.gap.size, 3))
            contact_velocities_into(contacts, step.v_mean, u)
            account_into(bodies, contacts, u, step, theta, squeezed, (0.0, 0.0, 0.0), progress)
            audit_into(contacts, n_contacts, progress)
            if press_anew(joints, contacts, n_contacts):
                joints = with_pressed(joints, contacts, n_contacts)
                record = with_room(record, joints.slip.size)
            contact_velocities_into(contacts, step.v, u)
            slip_into(contacts, n_contacts, u, h, theta, joints)
            audit[LAST_STEP] = h
            part += 1

            runaway = find_diverged(state)
            if runaway >= 0:
                clock[STEP] += 1
                return DIVERGED, runaway, contacts, joints, record
            record_until_into(
                bodies, ground, step.before, energy_before, contacts, n_contacts, joints, number, h, times,
                progress, record,
            )  # fmt: skip
        count_into(iterations, residual, settings.tolerance, parts, clock, audit)
        clock[STEP] += 1
        fallen = find_collapsed(bodies, state, watch.supported, watch.drop_limit)
        if fallen >= 0:
            return COLLAPSED, fallen, contacts, joints, record
    return COMPLETED, -1, contacts, joints, record


@inner_kernel
def _start(scene, ground, step, placed, progress):
    """Driven bodies where the motion has them at time zero, and the energy that the run starts with."""
    state, dt, theta = progress.state, scene.settings.dt, scene.settings.theta
    # a typed zero: for a literal one the whole detection would be compiled once more
    no_stoppers = np.int64(0)
    place_driven_into(scene.bodies, ground.displacement, ground.velocity, state)
    place_into(scene.polyhedra, state.position, state.orientation, placed)
    at_start = detect_contacts(
        scene.bodies, scene.polyhedra, placed, step.rotations, 0.0, scene.settings.shrink, scene.layers,
        theta * dt * dt, progress.face.copy(), no_stoppers,
    )  # fmt: skip
    start_audit(scene.bodies, at_start, dt, theta, 0.0, progress)


@inner_kernel
def _detect(bodies, stoppers, layers, polyhedra, settings, base, step, placed, face, dt):
    """Contacts at the predicted poses, the stoppers last, with their Delassus operators."""
    place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
    contacts = detect_contacts(
        bodies, polyhedra, placed, step.rotations, contact_margin(step.v_start, polyhedra.radius, bodies.gravity, dt),
        settings.shrink, layers, settings.theta * dt * dt, face, number_of(stoppers),
    )  # fmt: skip
    place_stoppers_into(bodies, stoppers, base, step, dt, settings.theta, contacts)
    delassus_into(bodies, step.inverse_inertia, contacts)
    return contacts


@kernel_without_allocation
def record_until_into(
    bodies, ground, before, energy_before, contacts, n_contacts, joints, number, dt, times, progress, record
):
    """Fill in the rows of the record whose times fall into a step, the one that began at ``number`` times ``dt``.

    ``before``, ``energy_before``: state and energy then; ``progress`` has those at the step's end.
    """
    clock = progress.clock
    while clock[NEXT_RECORD] < times.size and times[clock[NEXT_RECORD]] <= (number + 1 + ROUNDING) * dt:
        row, time = clock[NEXT_RECORD] - record.first[0], times[clock[NEXT_RECORD]]
        share = min(max(time / dt - number, 0.0), 1.0)
        record_into(bodies, before, progress.state, energy_before, progress.energy, share, row, record)
        move_ground_into(ground, time)
        record_driven_into(bodies, ground, row, record)
        record_forces_into(contacts, n_contacts, joints, dt, row, record)
        clock[NEXT_RECORD] += 1


@kernel_without_allocation
def least_impulse(bodies, gravity, v, dt):
    """Impulse below which all impulses of a step count as that [N s]: a thousandth of the lightest body's weight's.

    ``gravity``: its size [m/s2]. ``v`` (n_bodies, 6): velocities of the bodies.
    """
    lightest, momentum = np.inf, 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            lightest = min(lightest, bodies.mass[body])
            momentum += bodies.mass[body] * np.sqrt(dot(v[body, :3], v[body, :3]))
    return 1e-3 * dt * gravity * lightest + 1e-12 * momentum + 1e-300
