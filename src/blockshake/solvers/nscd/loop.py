"""The time loop of nonsmooth contact dynamics, compiled whole: predict, detect, solve, move, account, record."""

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import place_driven_into
from blockshake.jit import kernel
from blockshake.solvers.external_forces import external_wrenches_into
from blockshake.solvers.nscd.audit import account_into, audit_into, count_into, start_audit
from blockshake.solvers.nscd.contact.contacts import contact_margin, delassus_into, detect_contacts
from blockshake.solvers.nscd.contact.friction import friction_into
from blockshake.solvers.nscd.contact.law_shift import bodies_meet, law_shift_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.contact.stoppers import place_stoppers_into
from blockshake.solvers.nscd.contact.warm_start import warm_start_into
from blockshake.solvers.nscd.ground import ground_at_start, move_ground_by_secant_into, move_ground_into
from blockshake.solvers.nscd.joints import slip_into, with_pressed
from blockshake.solvers.nscd.progress import LAST_STEP
from blockshake.solvers.nscd.recording import record_driven_into, record_forces_into, record_into
from blockshake.solvers.nscd.solve.gauss_seidel import contact_velocities
from blockshake.solvers.nscd.solve.solver import solve_contacts_into
from blockshake.solvers.nscd.step import empty_step, move_into, predict_into
from blockshake.solvers.nscd.vectors import dot
from blockshake.solvers.record import with_room
from blockshake.solvers.status import COLLAPSED, COMPLETED, DIVERGED, NEXT_RECORD, PAUSED, SPEED_LIMIT, STEP

_ROUNDING = 1e-9  # of a step, when a record time meets the end of a step


@kernel
def integrate(scene, times, pause, progress, contacts, joints, record):
    """Integrate from where ``progress`` stands to the last record time, to a pause, to collapse or divergence.

    Parameters
    ----------
    scene : Scene
    times : float64 array, shape (n_times,)
        When to record, increasing from 0 [s].
    pause : int
        Number of steps made after which to pause.
    progress : Progress
        Changed in place.
    contacts : Contacts
        Of the step before, to start the next one from.
    joints : Joints
    record : Record
        Filled from the next record on.

    Returns
    -------
    code, culprit : int
        Of `blockshake.solvers.status`; body that collapsed or ran away, else -1.
    contacts, joints, record : Contacts, Joints, Record
        To go on with.

    Notes
    -----
    A step in which bodies meet is taken again in parts, each like a step of its own (``impact_parts``).
    """
    settings, state, clock = scene.settings, progress.state, progress.clock
    dt, theta = settings.dt, settings.theta
    step, placed, ground = empty_step(state), empty_placed(scene.polyhedra), ground_at_start(scene.table)
    energy_before = progress.energy.copy()
    meeting_speed = np.linalg.norm(scene.bodies.gravity) * dt
    if clock[STEP] == 0:
        _start(scene, ground, step, placed, progress)
    n_steps = int(np.ceil(times[times.size - 1] / dt - _ROUNDING))
    if n_steps == 0:
        record_into(scene.bodies, state, state, progress.energy, progress.energy, 0.0, 0, record)
        clock[NEXT_RECORD] = 1
    while clock[STEP] < n_steps:
        if clock[STEP] == pause:
            return PAUSED, -1, contacts, joints, record
        iterations, residual, part, parts = 0, 0.0, 0, 1
        while part < parts:
            h, place = dt / parts, clock[STEP] * parts + part
            move_ground_by_secant_into(ground, (place + 1.0 - theta) * h, (place + 2.0 - theta) * h, h)
            external_wrenches_into(
                scene.bodies, scene.forces, state, (place + 0.5) * h, 0.5 * h, step.external
            )
            step.external[:] *= h
            predict_into(scene.bodies, state, ground, h, theta, step)

            found = _detect(scene, step, placed, progress.face, h)
            n_contacts = found.gap.size - scene.stoppers.body.size
            share = h / progress.audit[LAST_STEP]
            tried, left = _solve(scene, contacts, joints, step, share, h, found)
            iterations += tried
            if parts < settings.impact_parts and bodies_meet(found, n_contacts, step.v_start, meeting_speed):
                parts = settings.impact_parts
                continue
            contacts, residual = found, max(residual, left)

            move_ground_into(ground, (place + 1) * h)
            move_into(scene.bodies, ground, h, theta, contacts, step, state)
            energy_before[:] = progress.energy
            account_into(
                scene.bodies, scene.stoppers, scene.watch.base, contacts, contact_velocities(contacts, step.v_mean),
                step, theta, (0.0, 0.0, 0.0), progress,
            )  # fmt: skip
            audit_into(contacts, n_contacts, progress)
            joints = with_pressed(joints, contacts, n_contacts)
            slip_into(contacts, n_contacts, contact_velocities(contacts, step.v), h, theta, joints)
            progress.audit[LAST_STEP] = h
            part += 1

            runaway = find_diverged(state)
            if runaway >= 0:
                clock[STEP] += 1
                return DIVERGED, runaway, contacts, joints, record
            record = with_room(record, joints.slip.size)
            record_until_into(
                scene.bodies, ground, step.before, energy_before, contacts, n_contacts, joints, place, h, times,
                progress, record,
            )  # fmt: skip
        count_into(iterations, residual, settings.tolerance, parts, clock, progress.audit)
        clock[STEP] += 1
        fallen = find_collapsed(scene.bodies, state, scene.watch.supported, scene.watch.drop_limit)
        if fallen >= 0:
            return COLLAPSED, fallen, contacts, joints, record
    return COMPLETED, -1, contacts, joints, record


@kernel
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


@kernel
def _detect(scene, step, placed, face, dt):
    """Contacts at the predicted poses, the stoppers last, with their Delassus operators."""
    bodies, settings, polyhedra = scene.bodies, scene.settings, scene.polyhedra
    place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
    margin = contact_margin(step.v_start, polyhedra.radius, bodies.gravity, dt)
    contacts = detect_contacts(
        bodies, polyhedra, placed, step.rotations, margin, settings.shrink, scene.layers,
        settings.theta * dt * dt, face, scene.stoppers.body.size,
    )  # fmt: skip
    place_stoppers_into(bodies, scene.stoppers, scene.watch.base, step, dt, settings.theta, contacts)
    delassus_into(bodies, step.inverse_inertia, contacts)
    return contacts


@kernel
def _solve(scene, contacts_before, joints, step, share, dt, contacts):
    """Contact law of the step, and the impulses that satisfy it; iterations made and residual left are returned.

    ``share``: length of the step over that of the step before [1], whose contacts are ``contacts_before``.
    """
    bodies, settings = scene.bodies, scene.settings
    friction_into(scene.friction, joints, step.rotations, contacts)
    law_shift_into(step, dt, settings.theta, settings.restitution, contacts)
    warm_start_into(contacts_before, scene.polyhedra.radius, share, contacts)
    floor = least_impulse(bodies, step.v, dt)
    return solve_contacts_into(
        bodies, step.inertia, step.inverse_inertia, contacts, floor, settings.tolerance,
        settings.max_iterations, step.v,
    )  # fmt: skip


@kernel
def record_until_into(
    bodies, ground, before, energy_before, contacts, n_contacts, joints, place, dt, times, progress, record
):
    """Fill in the rows of the record whose times fall into a step, the one that began at ``place`` times ``dt``.

    ``before``, ``energy_before``: state and energy then; ``progress`` has those at the step's end.
    """
    clock = progress.clock
    while clock[NEXT_RECORD] < times.size and times[clock[NEXT_RECORD]] <= (place + 1 + _ROUNDING) * dt:
        row = clock[NEXT_RECORD]
        share = min(max(times[row] / dt - place, 0.0), 1.0)
        record_into(bodies, before, progress.state, energy_before, progress.energy, share, row, record)
        move_ground_into(ground, times[row])
        record_driven_into(bodies, ground, row, record)
        record_forces_into(contacts, n_contacts, joints, dt, row, record)
        clock[NEXT_RECORD] += 1


@kernel
def least_impulse(bodies, v, dt):
    """Impulse below which all impulses of a step count as that [N s]: a thousandth of the lightest body's weight's."""
    gravity = np.linalg.norm(bodies.gravity)
    return 1e-3 * dt * gravity * _lightest(bodies) + 1e-12 * _momentum(bodies, v) + 1e-300


@kernel
def _lightest(bodies):
    """Least mass of a free body [kg]."""
    lightest = np.inf
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            lightest = min(lightest, bodies.mass[body])
    return lightest


@kernel
def _momentum(bodies, v):
    """Sum of the sizes of the free bodies' momenta [N s]."""
    total = 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            total += bodies.mass[body] * np.sqrt(dot(v[body, :3], v[body, :3]))
    return total


@kernel
def find_diverged(state):
    """First body whose state is not finite or that is faster than anything real, or -1."""
    for body in range(state.position.shape[0]):
        speed = 0.0
        for axis in range(3):
            speed += abs(state.velocity[body, axis]) + abs(state.angular_velocity[body, axis])
            speed += 0.0 * state.position[body, axis]
        # not (x < y), so that NaN counts
        if not speed < SPEED_LIMIT:
            return body
    return -1
