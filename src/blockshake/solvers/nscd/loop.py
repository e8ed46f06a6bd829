"""The time loop in compiled code: detect, solve, move, account, record."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import place_driven_into
from blockshake.jit import kernel
from blockshake.solvers.nscd.audit import account_into, audit_into, count_into, start_audit
from blockshake.solvers.nscd.contacts import detect_contacts, prepare_operators_into
from blockshake.solvers.nscd.friction import friction_into
from blockshake.solvers.nscd.joints import slip_into, with_joint
from blockshake.solvers.nscd.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.progress import LAST_STEP, NEXT_RECORD, STEP
from blockshake.solvers.nscd.recording import record_driven_into, record_forces_into, record_into
from blockshake.solvers.nscd.solver import solve_contacts_into
from blockshake.solvers.nscd.step import (
    bodies_meet,
    bounds_into,
    contact_margin,
    copy_state,
    empty_step,
    ground_displacement_into,
    move_into,
    predict_into,
)
from blockshake.solvers.nscd.stoppers import place_stoppers_into
from blockshake.solvers.nscd.vectors import dot
from blockshake.solvers.nscd.warm_start import warm_start_into
from blockshake.solvers.record import with_room

COMPLETED, COLLAPSED, DIVERGED, PAUSED = 0, 1, 2, 3
_FASTEST = 1e3  # m/s; nothing in an earthquake is, so the run has blown up
_ROUNDING = 1e-9  # of a step, when a record time meets the end of a step
_SPARE_JOINTS = 16


class Settings(NamedTuple):
    """Numbers of the method: ``dt`` [s]; ``restitution`` [1] of Newton; the rest as in `NscdParameters`."""

    dt: float
    theta: float
    tolerance: float
    max_iterations: int
    shrink: float
    restitution: float
    impact_parts: int


class Watch(NamedTuple):
    """Collapse limits of `collapse_limits`, and ``base``: first driven body of the file, -1 without one."""

    supported: np.ndarray
    drop_limit: np.ndarray
    base: int


@kernel
def integrate(
    bodies,
    friction,
    stoppers,
    layers,
    polyhedra,
    ground,
    settings,
    watch,
    times,
    pause,
    progress,
    contacts,
    joints,
    record,
):
    """Integrate from where ``progress`` stands to the last record time, to a pause, to collapse or divergence.

    Parameters
    ----------
    bodies, friction, stoppers, polyhedra : Bodies, Friction, Stoppers, Polyhedra
    layers : float64 array, shape (n_bodies, n_bodies)
        Compliance of the layers in the joints [m3/N].
    ground : MotionTable
        Motion of the driven bodies.
    settings, watch : Settings, Watch
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
    code : int
        `COMPLETED`, `COLLAPSED`, `DIVERGED` or `PAUSED`.
    culprit : int
        Body that collapsed or ran away, else -1.
    contacts, joints, record : Contacts, Joints, Record
        To go on with.
    """
    dt, theta = settings.dt, settings.theta
    state, clock = progress.state, progress.clock
    displacement, following, velocity = np.empty(4), np.empty(4), np.empty(4)
    # displacement counts from its start, pitch as it is
    origin, segment = np.zeros(4), 0
    segment = ground_displacement_into(ground, origin, 0.0, segment, displacement, velocity)
    origin[:3] = displacement[:3]
    step, placed = empty_step(state), empty_placed(polyhedra)
    if clock[STEP] == 0:
        displacement[:3] = 0.0
        place_driven_into(bodies, displacement, velocity, state)
        place_into(polyhedra, state.position, state.orientation, placed)
        at_start = detect_contacts(
            bodies, polyhedra, placed, step.rotations, 0.0, settings.shrink, layers, theta * dt * dt,
            progress.face.copy(), 0,
        )  # fmt: skip
        start_audit(bodies, at_start, dt, theta, progress)
    before, energy_before = copy_state(state), progress.energy.copy()
    gravity, lightest = np.linalg.norm(bodies.gravity), _lightest(bodies)
    n_steps = int(np.ceil(times[times.size - 1] / dt - _ROUNDING))
    if n_steps == 0:
        record_into(bodies, state, state, progress.energy, progress.energy, 0.0, 0, record)
        clock[NEXT_RECORD] = 1
    while clock[STEP] < n_steps:
        if clock[STEP] == pause:
            return PAUSED, -1, contacts, joints, record
        iterations, residual, part, parts = 0, 0.0, 0, 1
        while part < parts:
            # a step in which bodies meet is taken in parts, each like a step of its own
            h, place = dt / parts, clock[STEP] * parts + part
            segment = ground_displacement_into(
                ground, origin, (place + 1.0 - theta) * h, segment, displacement, velocity
            )
            segment = ground_displacement_into(
                ground, origin, (place + 2.0 - theta) * h, segment, following, velocity
            )
            for channel in range(4):
                velocity[channel] = (following[channel] - displacement[channel]) / h
            predict_into(bodies, state, displacement, velocity, h, theta, step)
            place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
            margin = contact_margin(step.v_start, polyhedra.radius, bodies.gravity, h)
            found = detect_contacts(
                bodies,
                polyhedra,
                placed,
                step.rotations,
                margin,
                settings.shrink,
                layers,
                theta * h * h,
                progress.face,
                stoppers.body.size,
            )
            n_contacts = found.gap.size - stoppers.body.size
            place_stoppers_into(bodies, stoppers, watch.base, step, h, theta, found)
            prepare_operators_into(bodies, step.inverse_inertia, found)
            friction_into(friction, joints, step.rotations, found)
            bounds_into(step, h, theta, settings.restitution, found)
            warm_start_into(contacts, polyhedra.radius, h / progress.audit[LAST_STEP], found)
            floor = 1e-3 * h * gravity * lightest + 1e-12 * _momentum(bodies, step.v) + 1e-300
            tried, left = solve_contacts_into(
                bodies,
                step.inertia,
                step.inverse_inertia,
                found,
                floor,
                settings.tolerance,
                settings.max_iterations,
                step.v,
            )
            iterations += tried
            if parts < settings.impact_parts and bodies_meet(found, n_contacts, step.v_start, gravity * dt):
                parts = settings.impact_parts
                continue
            contacts = found
            residual = max(residual, left)
            progress.audit[LAST_STEP] = h
            end = (place + 1) * h
            segment = ground_displacement_into(ground, origin, end, segment, displacement, velocity)
            move_into(bodies, displacement, velocity, h, theta, contacts, before, step, state)
            energy_before[:] = progress.energy
            account_into(
                bodies, stoppers, watch.base, state, contacts, step, theta, progress.audit, progress.energy
            )
            for contact in range(n_contacts):
                a, b = contacts.body_a[contact], contacts.body_b[contact]
                if joints.row[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
                    joints = with_joint(joints, a, b)
            slip_into(contacts, n_contacts, step.v, h, theta, joints)
            audit_into(contacts, n_contacts, progress)
            part += 1

            culprit = _find_diverged(state)
            if culprit >= 0:
                clock[STEP] += 1
                return DIVERGED, culprit, contacts, joints, record
            record = with_room(record, joints.slip.size, _SPARE_JOINTS)
            while (
                clock[NEXT_RECORD] < times.size and times[clock[NEXT_RECORD]] <= (place + 1 + _ROUNDING) * h
            ):
                row = clock[NEXT_RECORD]
                t = times[row]
                share = min(max(t / h - place, 0.0), 1.0)
                record_into(bodies, before, state, energy_before, progress.energy, share, row, record)
                segment = ground_displacement_into(ground, origin, t, segment, displacement, velocity)
                record_driven_into(bodies, displacement, velocity, row, record)
                record_forces_into(contacts, n_contacts, joints, h, row, record)
                clock[NEXT_RECORD] += 1
        count_into(iterations, residual, settings.tolerance, parts, clock, progress.audit)
        clock[STEP] += 1
        culprit = find_collapsed(bodies, state, watch.supported, watch.drop_limit)
        if culprit >= 0:
            return COLLAPSED, culprit, contacts, joints, record
    return COMPLETED, -1, contacts, joints, record


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
def _find_diverged(state):
    """First body whose state is not finite or that is faster than anything real, or -1."""
    for body in range(state.position.shape[0]):
        speed = 0.0
        for axis in range(3):
            speed += abs(state.velocity[body, axis]) + abs(state.angular_velocity[body, axis])
            speed += 0.0 * state.position[body, axis]
        # not (x < y), so that NaN counts
        if not speed < _FASTEST:
            return body
    return -1
