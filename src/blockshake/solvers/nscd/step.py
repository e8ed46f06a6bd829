"""Motion of the bodies in one time step, without contact and with it; rotations keep the angular momentum."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import State, place_driven_into
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into, rotation_rows
from blockshake.geometry.vectors import (
    add_impulse_into,
    columns_product,
    matrix_product,
    put_into,
    rows_product,
    tensor_in_world_into,
    transposed_product,
)
from blockshake.jit import inner_kernel, kernel_without_allocation

_MAX_ITERATIONS = 50
_ROUNDING = 1e-15


class Step(NamedTuple):
    """Work space of a step.

    ``before``: state at the start. ``detection``: poses at which contacts are found, and the driven bodies'
    velocities at the end of the step. ``rotations``, ``inertia`` and ``inverse_inertia`` (n_bodies, 3, 3): body to
    world, and [kg m2] and [1/(kg m2)] in the world frame, there. ``v_start``, ``v`` (n_bodies, 6): velocities at the
    start and at the end of the step. ``external`` (n_bodies, 6): impulse of external forces and its moment about the
    mass centre [N s, N m s]. ``v_mean`` (n_bodies, 6): mean of both velocities, rotation as in `turn_into`.
    ``impulse`` (n_bodies, 6): that of contacts and external forces together.
    """

    before: State
    detection: State
    rotations: np.ndarray
    inertia: np.ndarray
    inverse_inertia: np.ndarray
    v_start: np.ndarray
    v: np.ndarray
    external: np.ndarray
    v_mean: np.ndarray
    impulse: np.ndarray


@inner_kernel
def empty_step(state):
    """Work space for the bodies of a state."""
    n_bodies = state.position.shape[0]
    return Step(
        copy_state(state),
        copy_state(state),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.zeros((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
    )


@inner_kernel
def copy_state(state):
    """A copy that shares no array."""
    return State(
        state.position.copy(), state.orientation.copy(), state.velocity.copy(), state.angular_velocity.copy()
    )


@kernel_without_allocation
def predict_into(bodies, state, ground, dt, theta, step):
    """Poses at ``(1 - theta) dt`` into the step, and velocities at its end without contact, but for external impulses.

    ``ground`` (Ground): displacement there, and velocity at the end of the step. ``step.before`` and ``step.v_mean``
    are worked in.
    """
    detection, v = step.detection, step.v
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
            v[body, axis] = state.velocity[body, axis] + dt * bodies.gravity[axis]
            v[body, axis] += bodies.inverse_mass[body] * step.external[body, axis]
        w, share = state.angular_velocity[body], (1.0 - theta) * dt
        rotate_into(
            state.orientation[body], (share * w[0], share * w[1], share * w[2]), detection.orientation[body]
        )
        turn_into(
            state.orientation[body],
            state.angular_velocity[body],
            bodies.inertia[body],
            bodies.inverse_inertia[body],
            step.external[body, 3:],
            dt,
            theta,
            step.before.orientation[body],
            v[body, 3:],
            step.v_mean[body, 3:],
        )
    place_driven_into(bodies, ground.displacement, ground.velocity, detection)
    for body in range(bodies.mass.size):
        R = step.rotations[body]
        rotation_matrix_into(detection.orientation[body], R)
        tensor_in_world_into(R, bodies.inertia[body], step.inertia[body])
        tensor_in_world_into(R, bodies.inverse_inertia[body], step.inverse_inertia[body])
        if bodies.driven[body]:
            put_into(detection.velocity[body], v[body, :3])
            put_into(detection.angular_velocity[body], v[body, 3:])


@kernel_without_allocation
def move_into(bodies, ground, dt, theta, contacts, step, state):
    """Newton-Euler equations: poses and velocities at the end of the step under gravity and all impulses.

    ``ground`` (Ground): at the end of the step. ``step.before`` is overwritten with the state at the start.
    """
    before = step.before
    for body in range(bodies.mass.size):
        for axis in range(3):
            before.position[body, axis] = state.position[body, axis]
            before.velocity[body, axis] = state.velocity[body, axis]
            before.angular_velocity[body, axis] = state.angular_velocity[body, axis]
        for part in range(4):
            before.orientation[body, part] = state.orientation[body, part]
        for i in range(6):
            step.impulse[body, i] = step.external[body, i]
    for contact in range(contacts.gap.size):
        world = transposed_product(contacts.basis[contact], contacts.impulse[contact])
        add_impulse_into(-1.0, world, contacts.arm_a[contact], step.impulse[contacts.body_a[contact]])
        add_impulse_into(1.0, world, contacts.arm_b[contact], step.impulse[contacts.body_b[contact]])
    place_driven_into(bodies, ground.displacement, ground.velocity, state)
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


@kernel_without_allocation
def _rotated(rotation, x):
    """Vector ``x`` turned by a rotation vector [rad], by Rodrigues' formula."""
    rx, ry, rz = rotation[0], rotation[1], rotation[2]
    angle = np.sqrt(rx * rx + ry * ry + rz * rz)
    # series near zero, where the quotients are 0/0
    s = 1.0 - angle * angle / 6.0 if angle < 1e-4 else np.sin(angle) / angle
    half = np.sin(0.5 * angle)
    c = 0.5 - angle * angle / 24.0 if angle < 1e-4 else 2.0 * half * half / (angle * angle)
    ux, uy, uz = ry * x[2] - rz * x[1], rz * x[0] - rx * x[2], rx * x[1] - ry * x[0]
    return (
        x[0] + s * ux + c * (ry * uz - rz * uy),
        x[1] + s * uy + c * (rz * ux - rx * uz),
        x[2] + s * uz + c * (rx * uy - ry * ux),
    )


@kernel_without_allocation
def _weighted(start, end, theta, factor):
    """``factor`` times the mean of two vectors, the second with weight ``theta``."""
    return (
        factor * ((1.0 - theta) * start[0] + theta * end[0]),
        factor * ((1.0 - theta) * start[1] + theta * end[1]),
        factor * ((1.0 - theta) * start[2] + theta * end[2]),
    )


@kernel_without_allocation
def turn_into(
    orientation, spin, inertia, inverse_inertia, torque, dt, theta, new_orientation, new_spin, mean_spin
):
    """Orientation and angular velocity at the end of a step.

    Parameters
    ----------
    orientation, spin : float64 arrays, shape (4,) and (3,)
        Unit quaternion and angular velocity at the start, world frame [rad/s].
    inertia, inverse_inertia : float64 arrays, shape (3, 3)
        Body frame [kg m2, 1/(kg m2)].
    torque : float64 array, shape (3,)
        Impulse moment of the step about the mass centre, world frame [N m s].
    dt, theta : float
        Step [s] and weight of the end of the step.
    new_orientation, new_spin, mean_spin : float64 arrays, shape (4,), (3,), (3,)
        Overwritten; ``new_orientation`` must not be ``orientation``. The last is the mean of the two angular
        velocities, taken in the body frame and turned into the world by the orientation at the start [rad/s].

    Notes
    -----
    The midpoint scheme with convected velocities of Simo and Wong (1991): ``R1 J W1 = R0 J W0 + torque`` with
    ``R1 = R0 exp(dt W)`` and ``W = (1 - theta) W0 + theta W1`` in the body frame, by fixed-point iteration. As
    ``exp(dt W)`` leaves ``W`` alone, the kinetic energy changes at theta 0.5 by exactly ``torque`` times ``mean_spin``.
    """
    R = rotation_rows(orientation)
    start, added = columns_product(R, spin), columns_product(R, torque)
    kept = matrix_product(inertia, start)
    target = (kept[0] + added[0], kept[1] + added[1], kept[2] + added[2])
    end = matrix_product(inverse_inertia, target)
    for _ in range(_MAX_ITERATIONS):
        following = matrix_product(inverse_inertia, _rotated(_weighted(start, end, theta, -dt), target))
        change = max(abs(following[0] - end[0]), max(abs(following[1] - end[1]), abs(following[2] - end[2])))
        size = max(abs(following[0]), max(abs(following[1]), abs(following[2])))
        end = following
        if change <= _ROUNDING * size:
            break
    rotate_into(orientation, rows_product(R, _weighted(start, end, theta, dt)), new_orientation)
    put_into(rows_product(R, _weighted(start, end, 0.5, 1.0)), mean_spin)
    put_into(rows_product(rotation_rows(new_orientation), end), new_spin)
