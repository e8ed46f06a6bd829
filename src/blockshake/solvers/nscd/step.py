"""The parts of one time step, in physical order: predict, bound, move."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.motion import find_segment, ground_state_into
from blockshake.dynamics.system import place_driven_into
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.jit import kernel
from blockshake.solvers.nscd.gauss_seidel import relative_velocity
from blockshake.solvers.nscd.rotation_step import turn_into
from blockshake.solvers.nscd.vectors import cross, dot, put_into, turned_back, turned_tensor_into

# Contacts are looked for at least this far apart, since a body at rest may be pushed within a step [m].
_LEAST_MARGIN = 1e-4


class Step(NamedTuple):
    """Work space of a step.

    ``detection`` (State): poses at which contacts are found, and the driven bodies' velocities at
    the end of the step. ``rotations``, ``inertia`` and ``inverse_inertia`` (n_bodies, 3, 3): body to
    world, and [kg m2] and [1/(kg m2)] in the world frame, there. ``v_start``, ``v`` (n_bodies, 6):
    velocities at the start and at the
    end of the step. ``v_mean`` (n_bodies, 6): their mean, rotation as in `turn_into`. ``impulse``
    (n_bodies, 6): contact impulse and its moment about the mass centre [N s, N m s].
    """

    detection: tuple
    rotations: np.ndarray
    inertia: np.ndarray
    inverse_inertia: np.ndarray
    v_start: np.ndarray
    v: np.ndarray
    v_mean: np.ndarray
    impulse: np.ndarray


@kernel
def empty_step(state):
    """Work space for the bodies of a state."""
    n_bodies = state.position.shape[0]
    return Step(
        copy_state(state),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
    )


@kernel
def copy_state(state):
    """A copy that shares no array."""
    return type(state)(
        state.position.copy(), state.orientation.copy(), state.velocity.copy(), state.angular_velocity.copy()
    )


@kernel
def ground_displacement_into(table, origin, t, segment, displacement, velocity):
    """Ground displacement since ``origin`` and its rate at one time; the segment is returned."""
    segment = find_segment(table.breaks, t, segment)
    ground_state_into(table, segment, t, displacement, velocity)
    for channel in range(4):
        displacement[channel] -= origin[channel]
    return segment


@kernel
def predict_into(bodies, state, displacement, velocity, dt, theta, step):
    """Poses at ``(1 - theta) dt`` into the step, and velocities at its end without contact.

    ``displacement`` and ``velocity`` (4,): of the ground, there and at the end of the step.
    """
    detection, v = step.detection, step.v
    rotation, no_torque = np.empty(3), np.zeros(3)
    orientation, mean = np.empty(4), np.empty(3)
    for body in range(bodies.mass.size):
        for axis in range(3):
            step.v_start[body, axis] = state.velocity[body, axis]
            step.v_start[body, 3 + axis] = state.angular_velocity[body, axis]
        if bodies.driven[body]:
            continue
        for axis in range(3):
            detection.position[body, axis] = (
                state.position[body, axis] + (1.0 - theta) * dt * state.velocity[body, axis]
            )
            rotation[axis] = (1.0 - theta) * dt * state.angular_velocity[body, axis]
            v[body, axis] = state.velocity[body, axis] + dt * bodies.gravity[axis]
        rotate_into(state.orientation[body], rotation, detection.orientation[body])
        turn_into(
            state.orientation[body],
            state.angular_velocity[body],
            bodies.inertia[body],
            bodies.inverse_inertia[body],
            no_torque,
            dt,
            theta,
            orientation,
            v[body, 3:],
            mean,
        )
    place_driven_into(bodies, displacement, velocity, detection)
    for body in range(bodies.mass.size):
        R = step.rotations[body]
        rotation_matrix_into(detection.orientation[body], R)
        turned_tensor_into(R, bodies.inertia[body], step.inertia[body])
        turned_tensor_into(R, bodies.inverse_inertia[body], step.inverse_inertia[body])
        if bodies.driven[body]:
            put_into(detection.velocity[body], v[body, :3])
            put_into(detection.angular_velocity[body], v[body, 3:])


@kernel
def contact_margin(v_start, radius, gravity, dt):
    """Gap up to which points of two bodies are kept as contacts: what no pair can close in a step [m]."""
    fastest = 0.0
    for body in range(radius.size):
        v = v_start[body]
        fastest = max(fastest, np.sqrt(dot(v[:3], v[:3])) + radius[body] * np.sqrt(dot(v[3:], v[3:])))
    return _LEAST_MARGIN + 2.0 * dt * (fastest + dt * np.sqrt(dot(gravity, gravity)))


@kernel
def bounds_into(step, dt, theta, restitution, contacts):
    """Fill in the velocities that the contact law adds to those of the contacts.

    Notes
    -----
    Poses of detection are ``dt`` apart, and the velocity at the end of a step carries one to the
    next: ``gap + dt u_n`` is the next gap. So ``u_n + max(gap, 0) / dt >= 0`` lets a contact close
    and no more, and leaves a penetration as it is. ``u`` must be measured with the levers halfway between these
    two poses; those at hand are ``dt / 2`` older, and the difference is the centripetal velocity added here.
    Newton's restitution replaces the anticipated gap where the velocity at the start would close the gap within the
    step. The law of a stop and of a layer is implicit: impulse ``dt k`` times the closure at the end. All points of a
    layer press at once, and what the levers add along it is that of its deepest point for all of them: else those that
    stick would be stretched apart, and hold the block.
    """
    a, b, deepest = -1, -1, 0
    for contact in range(contacts.gap.size):
        basis, bound = contacts.basis[contact], contacts.bound[contact]
        gap = contacts.gap[contact]
        if contacts.body_a[contact] != a or contacts.body_b[contact] != b:
            a, b, deepest = (
                contacts.body_a[contact],
                contacts.body_b[contact],
                _deepest_of_pair(contacts, contact),
            )
        layered = contacts.compliance[contact] > 0.0 and contacts.stopper[contact] < 0
        turn = _turn_of_levers(step, contacts, contact)
        along = _turn_of_levers(step, contacts, deepest if layered else contact)
        bound[0] = 0.5 * dt * dot(basis[0], turn)
        bound[1], bound[2] = 0.5 * dt * dot(basis[1], along), 0.5 * dt * dot(basis[2], along)
        if contacts.compliance[contact] > 0.0:
            bound[0] += gap / (theta * dt)
            continue
        closing, _, _ = relative_velocity(contacts, contact, step.v_start)
        if restitution > 0.0 and closing < 0.0 and gap + dt * closing <= 0.0:
            bound[0] += restitution * closing
        else:
            bound[0] += max(gap, 0.0) / dt


@kernel
def _deepest_of_pair(contacts, first):
    """The contact with the least gap among those of the pair of bodies that begin at ``first``."""
    deepest, contact = first, first
    while (
        contact < contacts.gap.size
        and contacts.body_a[contact] == contacts.body_a[first]
        and contacts.body_b[contact] == contacts.body_b[first]
    ):
        if contacts.gap[contact] < contacts.gap[deepest]:
            deepest = contact
        contact += 1
    return deepest


@kernel
def _turn_of_levers(step, contacts, contact):
    """Centripetal acceleration of b's point less that of a's [m/s2]."""
    of_b = _centripetal(step.v_start[contacts.body_b[contact], 3:], contacts.arm_b[contact])
    of_a = _centripetal(step.v_start[contacts.body_a[contact], 3:], contacts.arm_a[contact])
    return of_b[0] - of_a[0], of_b[1] - of_a[1], of_b[2] - of_a[2]


@kernel
def bodies_meet(contacts, n_contacts, v_start, speed):
    """Whether a contact of bodies presses that closed faster than ``speed`` [m/s] when the step began."""
    for contact in range(n_contacts):
        if contacts.impulse[contact, 0] > 0.0:
            closing, _, _ = relative_velocity(contacts, contact, v_start)
            if closing < -speed:
                return True
    return False


@kernel
def _centripetal(spin, arm):
    """``spin x (spin x arm)`` [m/s2]."""
    along, squared = dot(spin, arm), dot(spin, spin)
    return (
        along * spin[0] - squared * arm[0],
        along * spin[1] - squared * arm[1],
        along * spin[2] - squared * arm[2],
    )


@kernel
def move_into(bodies, displacement, velocity, dt, theta, contacts, before, step, state):
    """Poses and velocities at the end of the step under gravity and the contacts' impulses.

    ``displacement`` and ``velocity`` (4,): of the ground at the end of the step. ``before`` is overwritten
    with the state at the start.
    """
    before.position[:] = state.position
    before.orientation[:] = state.orientation
    before.velocity[:] = state.velocity
    before.angular_velocity[:] = state.angular_velocity
    step.impulse[:] = 0.0
    for contact in range(contacts.gap.size):
        world = turned_back(contacts.basis[contact], contacts.impulse[contact])
        for sign, body, arm in (
            (-1.0, contacts.body_a[contact], contacts.arm_a[contact]),
            (1.0, contacts.body_b[contact], contacts.arm_b[contact]),
        ):
            total, moment = step.impulse[body], cross(arm, world)
            for axis in range(3):
                total[axis] += sign * world[axis]
                total[3 + axis] += sign * moment[axis]
    place_driven_into(bodies, displacement, velocity, state)
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            put_into(step.v[body, :3], state.velocity[body])
            put_into(step.v[body, 3:], state.angular_velocity[body])
            for i in range(6):
                step.v_mean[body, i] = 0.5 * (step.v_start[body, i] + step.v[body, i])
            continue
        for axis in range(3):
            old = before.velocity[body, axis]
            new = old + dt * bodies.gravity[axis] + bodies.inverse_mass[body] * step.impulse[body, axis]
            state.velocity[body, axis] = new
            state.position[body, axis] += dt * ((1.0 - theta) * old + theta * new)
            step.v_mean[body, axis] = 0.5 * (old + new)
        turn_into(
            before.orientation[body],
            before.angular_velocity[body],
            bodies.inertia[body],
            bodies.inverse_inertia[body],
            step.impulse[body, 3:],
            dt,
            theta,
            state.orientation[body],
            state.angular_velocity[body],
            step.v_mean[body, 3:],
        )
