"""The whole run in compiled code: detect, solve, move, account, record."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.system import State, kinetic_energy, place_driven_into, potential_energy
from blockshake.geometry.rotations import rotate_into
from blockshake.jit import kernel
from blockshake.solvers.nscd.contacts import (
    detect_contacts,
    empty_contacts,
    prepare_operators_into,
    warm_start_into,
)
from blockshake.solvers.nscd.polyhedra import empty_placed, place_into
from blockshake.solvers.nscd.solver import solve_contacts_into
from blockshake.solvers.nscd.step import (
    Step,
    account_into,
    bounds_into,
    contact_margin,
    copy_state,
    ground_displacement_into,
    move_into,
    place_stoppers_into,
    predict_into,
)

COMPLETED, COLLAPSED, DIVERGED = 0, 1, 2
# Relative residual above which a step counts as badly solved; fixed by the project's contract.
BAD_RESIDUAL = 1e-4
_FASTEST = 1e3  # m/s; nothing in an earthquake is, so the run has blown up
_ROUNDING = 1e-9  # of a step, when a record time meets the end of a step


class Settings(NamedTuple):
    """Numbers of the method: ``dt`` [s]; ``restitution`` [1] of Newton; the rest as in `NscdParameters`."""

    dt: float
    theta: float
    tolerance: float
    max_iterations: int
    shrink: float
    restitution: float


class Watch(NamedTuple):
    """Collapse limits of `collapse_limits`, and ``base``: first driven body of the file, -1 without one."""

    supported: np.ndarray
    drop_limit: np.ndarray
    base: int


class Record(NamedTuple):
    """What is kept at the record times; arrays as in `Trajectory`, written in place."""

    time: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    energy: np.ndarray


class Tally(NamedTuple):
    """Figures of a run, counted as it goes."""

    steps: int
    sweeps: int
    most_sweeps: int
    worst_residual: float
    bad_steps: int
    capped_steps: int
    energy_residual: float
    energy_scale: float
    deepest: float


@kernel
def run(bodies, state, stoppers, polyhedra, table, settings, watch, record):
    """Integrate to the last record time, or to collapse or divergence.

    Parameters
    ----------
    bodies : Bodies
    state : State
        At time zero; changed in place.
    stoppers : Stoppers
    polyhedra : Polyhedra
    table : MotionTable
    settings : Settings
    watch : Watch
    record : Record
        ``time`` is given, the rest starts as NaN and is filled in.

    Returns
    -------
    code : int
        `COMPLETED`, `COLLAPSED` or `DIVERGED`.
    culprit : int
        Body that collapsed or ran away, else -1.
    end_time : float
        [s]
    joints : int64 array, shape (n_joints, 2)
        Pairs that touched, the body with the lower index first.
    joint_force : float64 array, shape (n_times, n_joints, 3)
        On the second body [N].
    tally : Tally
    """
    dt, theta = settings.dt, settings.theta
    n_bodies, n_times = bodies.mass.size, record.time.size
    displacement, following, velocity = np.empty(4), np.empty(4), np.empty(4)
    origin, segment = np.zeros(4), 0
    segment = ground_displacement_into(table, origin, 0.0, segment, displacement, velocity)
    # displacement counts from its start, pitch as it is
    origin[:3] = displacement[:3]
    displacement[:3] = 0.0
    place_driven_into(bodies, displacement, velocity, state)
    step = Step(
        copy_state(state),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 3, 3)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
        np.empty((n_bodies, 6)),
    )
    before = copy_state(state)
    placed = empty_placed(polyhedra)
    memory = np.full((n_bodies, n_bodies), -1, np.int64)
    old = empty_contacts(0)
    joint_of = np.full((n_bodies, n_bodies), -1, np.int64)
    joints, joint_force = np.empty((16, 2), np.int64), np.full((n_times, 16, 3), np.nan)
    n_joints = 0
    energy, energy_before, work = np.zeros(7), np.empty(7), np.zeros(2)
    energy[0] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
    energy[1] = potential_energy(bodies, state.position)
    energy_start = energy.copy()
    weight = 0.0
    lightest = np.inf
    for body in range(n_bodies):
        if not bodies.driven[body]:
            weight += bodies.mass[body] * np.linalg.norm(bodies.gravity)
            lightest = min(lightest, bodies.mass[body])
    # the energy that lifts everything by a millimetre: less is never "in play"
    energy_scale, energy_residual = 1e-3 * weight, 0.0
    sweeps_sum, most_sweeps, worst, bad, capped, deepest = 0, 0, 0.0, 0, 0, 0.0
    code, culprit, row, index = COMPLETED, -1, 0, 0
    n_steps = int(np.ceil(record.time[n_times - 1] / dt - _ROUNDING))
    segment = ground_displacement_into(table, origin, (1.0 - theta) * dt, segment, following, velocity)
    while index < n_steps:
        displacement[:] = following
        segment = ground_displacement_into(
            table, origin, (index + 2.0 - theta) * dt, segment, following, velocity
        )
        for channel in range(4):
            velocity[channel] = (following[channel] - displacement[channel]) / dt
        predict_into(bodies, state, displacement, velocity, dt, theta, step)
        place_into(polyhedra, step.detection.position, step.detection.orientation, placed)
        margin = contact_margin(step.v_start, polyhedra.radius, bodies.gravity, dt)
        contacts = detect_contacts(
            bodies, polyhedra, placed, step.rotations, margin, settings.shrink, memory, stoppers.body.size
        )
        place_stoppers_into(bodies, stoppers, watch.base, step, dt, theta, contacts)
        prepare_operators_into(bodies, step.inverse_inertia, contacts)
        bounds_into(step, dt, theta, settings.restitution, contacts)
        warm_start_into(old, polyhedra.radius, contacts)
        floor = (
            1e-3 * dt * np.linalg.norm(bodies.gravity) * lightest + 1e-12 * _momentum(bodies, step.v) + 1e-300
        )
        sweeps, residual = solve_contacts_into(
            bodies,
            step.inertia,
            step.inverse_inertia,
            contacts,
            floor,
            settings.tolerance,
            settings.max_iterations,
            step.v,
        )
        segment = ground_displacement_into(table, origin, (index + 1) * dt, segment, displacement, velocity)
        move_into(bodies, displacement, velocity, dt, theta, contacts, before, step, state)
        energy_before[:] = energy
        account_into(bodies, stoppers, watch.base, state, contacts, step, work, energy)
        index += 1

        sweeps_sum += sweeps
        most_sweeps = max(most_sweeps, sweeps)
        worst = max(worst, residual)
        bad += 1 if residual > BAD_RESIDUAL else 0
        capped += 1 if residual > settings.tolerance else 0
        for contact in range(contacts.gap.size - stoppers.body.size):
            deepest = max(deepest, -contacts.gap[contact])
            a, b = contacts.body_a[contact], contacts.body_b[contact]
            if joint_of[a, b] < 0 and contacts.impulse[contact, 0] > 0.0:
                if n_joints == joints.shape[0]:
                    joints = np.concatenate((joints, np.empty((n_joints, 2), np.int64)))
                    joint_force = np.concatenate(
                        (joint_force, np.full((n_times, n_joints, 3), np.nan)), axis=1
                    )
                # a pair that touches for the first time carried nothing at the times already kept
                joint_force[:row, n_joints] = 0.0
                joints[n_joints, 0], joints[n_joints, 1] = a, b
                joint_of[a, b] = n_joints
                n_joints += 1
        scale = (
            energy[0] + abs(energy[1] - energy_start[1]) + energy[2] + energy[3] + energy[4] + abs(energy[6])
        )
        energy_scale = max(energy_scale, scale)
        balance = energy[0] + energy[1] + energy[2] + energy[3] + energy[4] - energy[6]
        energy_residual = max(
            energy_residual, abs(balance - energy_start[0] - energy_start[1] - energy_start[2])
        )

        culprit = _find_diverged(state)
        if culprit >= 0:
            code = DIVERGED
            break
        while row < n_times and record.time[row] <= (index + _ROUNDING) * dt:
            share = min(max(record.time[row] / dt - (index - 1), 0.0), 1.0)
            _record_into(bodies, before, state, energy_before, energy, share, row, record)
            segment = ground_displacement_into(
                table, origin, record.time[row], segment, displacement, velocity
            )
            _record_driven_into(bodies, displacement, velocity, row, record)
            joint_force[row, :n_joints] = 0.0
            for contact in range(contacts.gap.size - stoppers.body.size):
                joint = joint_of[contacts.body_a[contact], contacts.body_b[contact]]
                if joint >= 0:
                    joint_force[row, joint] += contacts.impulse[contact] @ contacts.basis[contact] / dt
            row += 1
        old = contacts
        culprit = find_collapsed(bodies, state, watch.supported, watch.drop_limit)
        if culprit >= 0:
            code = COLLAPSED
            break
    if n_steps == 0:
        _record_into(bodies, state, state, energy, energy, 0.0, 0, record)
    tally = Tally(index, sweeps_sum, most_sweeps, worst, bad, capped, energy_residual, energy_scale, deepest)
    end_time = min(index * dt, record.time[n_times - 1])
    return code, culprit, end_time, joints[:n_joints].copy(), joint_force[:, :n_joints].copy(), tally


@kernel
def _momentum(bodies, v):
    """Sum of the sizes of the free bodies' momenta [N s]."""
    total = 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            total += bodies.mass[body] * np.linalg.norm(v[body, :3])
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


@kernel
def _record_into(bodies, before, after, energy_before, energy, share, row, record):
    """Keep the state at a share of the step: linear, rotations along the step's own."""
    turn = np.empty(3)
    for body in range(bodies.mass.size):
        for axis in range(3):
            for kept, old, new in (
                (record.position, before.position, after.position),
                (record.velocity, before.velocity, after.velocity),
                (record.angular_velocity, before.angular_velocity, after.angular_velocity),
            ):
                kept[row, body, axis] = (1.0 - share) * old[body, axis] + share * new[body, axis]
        _rotation_between_into(before.orientation[body], after.orientation[body], turn)
        rotate_into(before.orientation[body], share * turn, record.orientation[row, body])
    for term in range(energy.size):
        record.energy[row, term] = (1.0 - share) * energy_before[term] + share * energy[term]


@kernel
def _rotation_between_into(start, end, rotation):
    """World rotation vector [rad] that turns quaternion ``start`` into ``end``."""
    w, x, y, z = start[0], -start[1], -start[2], -start[3]
    a, b, c, d = end[0], end[1], end[2], end[3]
    scalar = a * w - b * x - c * y - d * z
    rotation[0] = a * x + b * w + c * z - d * y
    rotation[1] = a * y - b * z + c * w + d * x
    rotation[2] = a * z + b * y - c * x + d * w
    sine = np.sqrt(rotation[0] ** 2 + rotation[1] ** 2 + rotation[2] ** 2)
    if sine > 0.0:
        factor = 2.0 * np.arctan2(sine, scalar) / sine
        for axis in range(3):
            rotation[axis] *= factor


@kernel
def _record_driven_into(bodies, displacement, velocity, row, record):
    """Overwrite the driven bodies with the ground motion itself at the record time."""
    kept = State(
        record.position[row], record.orientation[row], record.velocity[row], record.angular_velocity[row]
    )
    place_driven_into(bodies, displacement, velocity, kept)
