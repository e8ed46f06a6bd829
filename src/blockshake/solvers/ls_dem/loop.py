"""The time loop of LS-DEM, compiled whole: detect, force, kick, record, drift."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.free_motion import drift_into, spin_into
from blockshake.dynamics.motion import find_segment, ground_state_into
from blockshake.dynamics.system import kinetic_energy, place_driven_into, potential_energy
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.jit import kernel
from blockshake.solvers.ls_dem.candidates import find_candidates, lists_expired
from blockshake.solvers.ls_dem.contact import (
    DAMPING,
    ELASTIC,
    FRICTION,
    Loads,
    contact_forces_into,
)
from blockshake.solvers.ls_dem.relative_motion import Kinematics
from blockshake.solvers.ls_dem.stoppers import stopper_forces_into

COMPLETED, COLLAPSED, DIVERGED = 0, 1, 2
_SPEED_LIMIT = 1e3  # m/s; nothing that falls or shakes here comes near it


class Record(NamedTuple):
    """What a run leaves, NaN where it did not come to; arrays as in `Trajectory`."""

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    energy: np.ndarray
    joint_force: np.ndarray


@kernel
def clear_loads(bodies, loads):
    """Start a force evaluation: gravity on every free body, nothing else."""
    loads.moment[:] = 0.0
    loads.joint_force[:] = 0.0
    loads.energy[:] = 0.0
    for body in range(bodies.mass.size):
        for axis in range(3):
            loads.force[body, axis] = 0.0 if bodies.driven[body] else bodies.mass[body] * bodies.gravity[axis]


@kernel
def _put_driven_into(bodies, displacement, velocity, state, kinematics):
    """Place the driven bodies where the ground has them, with its velocity."""
    place_driven_into(bodies, displacement, velocity, state)
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            for axis in range(3):
                kinematics.velocity[body, axis] = state.velocity[body, axis]
                kinematics.spin[body, axis] = state.angular_velocity[body, axis]


@kernel
def _angular_momentum_into(bodies, state, momentum):
    """Angular momentum of every free body about its mass centre, world frame [kg m2/s]."""
    R = np.empty((3, 3))
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            rotation_matrix_into(state.orientation[body], R)
            momentum[body] = R @ (bodies.inertia[body] @ (R.T @ state.angular_velocity[body]))


@kernel
def _has_diverged(velocity):
    """Whether a velocity is beyond the limit or no number."""
    for body in range(velocity.shape[0]):
        for axis in range(3):
            # not (x <= limit), so that NaN counts
            if not abs(velocity[body, axis]) <= _SPEED_LIMIT:
                return True
    return False


@kernel
def integrate(
    bodies,
    surfaces,
    interfaces,
    stoppers,
    ground,
    supported,
    drop_limit,
    skin,
    dt,
    n_steps,
    times,
    state,
    candidates,
    record,
):
    """Run LS-DEM over ``n_steps`` steps.

    Parameters
    ----------
    bodies, surfaces, interfaces, stoppers : Bodies, Surfaces, Interfaces, Stoppers
    ground : MotionTable
        Motion of the driven bodies.
    supported : bool array, shape (n_bodies,)
    drop_limit : float64 array, shape (n_bodies,)
        Criterion of collapse, see `find_collapsed` [m].
    skin, dt : float
        Reach of the lists [m], time step [s].
    n_steps : int
    times : float64 array, shape (n_times,)
        When to record, increasing from 0 [s].
    state : State
        At the start; at the end of the run on return.
    candidates : Candidates
        Near nodes with the shear forces of the start.
    record : Record
        Overwritten.

    Returns
    -------
    status, body, step, rebuilds : int
        Status code, body that collapsed or -1, last step, number of list searches.
    joint : int64 array, shape (n_bodies, n_bodies)
        Row of ``record.joint_force`` of each pair (first < second), -1 where they never touched.

    Notes
    -----
    Leapfrog (velocity Verlet): momenta at half steps, poses at full steps. The force at a step
    sees the dashpot velocities extrapolated to that step, ``v(n-1/2) + dt/2 a(n-1)``, which keeps
    the scheme of second order with damping. Heat, input work and elastic energy are summed so
    that their balance closes but for the error of the scheme.
    """
    n_bodies = bodies.mass.size
    half_velocity, half_spin = state.velocity.copy(), np.zeros((n_bodies, 3))  # at half steps, as is
    momentum = np.zeros((n_bodies, 3))  # the angular momentum
    turn = np.empty(3)
    kinematics = Kinematics(
        state.position, np.empty((n_bodies, 3, 3)), np.empty((n_bodies, 3)), np.empty((n_bodies, 3, 3)),
        state.velocity.copy(), state.angular_velocity.copy(),
    )  # fmt: skip
    loads = Loads(
        np.zeros((n_bodies, 3)), np.zeros((n_bodies, 3)),
        np.full((n_bodies, n_bodies), -1, np.int64), np.zeros((record.joint_force.shape[1], 3)), np.zeros(3),
    )  # fmt: skip
    _angular_momentum_into(bodies, state, momentum)
    now, before, velocity = np.zeros(4), np.zeros(4), np.zeros(4)
    driven_force, driven_moment = np.zeros((n_bodies, 3)), np.zeros((n_bodies, 3))
    friction_heat = most_friction = damping_heat = work = 0.0
    segment = rebuilds = next_time = 0
    start = ground.coefficients[0, :, 0].copy()
    start[3] = 0.0
    for step in range(n_steps + 1):
        t = step * dt
        before[:] = now
        segment = find_segment(ground.breaks, t, segment)
        ground_state_into(ground, segment, t, now, velocity)
        now -= start
        _put_driven_into(bodies, now, velocity, state, kinematics)
        for body in range(n_bodies):
            rotation_matrix_into(state.orientation[body], kinematics.rotation[body])
        if step == 0:
            before[:] = now
            kinematics.position_before[:] = state.position
            kinematics.rotation_before[:] = kinematics.rotation

        if lists_expired(candidates, surfaces, bodies.driven, state.position, state.orientation, skin):
            candidates = find_candidates(
                surfaces, bodies.driven, state.position, state.orientation, skin, candidates
            )
            rebuilds += 1
        clear_loads(bodies, loads)
        # the first force sees no motion before it: the springs of the start hold as they are
        contact_forces_into(candidates, surfaces, interfaces, kinematics, dt if step > 0 else 0.0, loads)
        kinematics.position_before[:] = state.position
        kinematics.rotation_before[:] = kinematics.rotation
        loads.energy[ELASTIC] += stopper_forces_into(bodies, stoppers, state, loads)
        friction_heat += loads.energy[FRICTION]
        # a node that lets go while its slip reverses gives back some microjoules of a step's error
        most_friction = max(most_friction, friction_heat)
        damping_heat += loads.energy[DAMPING]
        for body in range(n_bodies):
            if bodies.driven[body]:
                for axis in range(3):
                    moved = now[axis] - before[axis]
                    turned = now[3] - before[3] if axis == 1 else 0.0
                    work -= 0.5 * (loads.force[body, axis] + driven_force[body, axis]) * moved
                    work -= 0.5 * (loads.moment[body, axis] + driven_moment[body, axis]) * turned
                    driven_force[body, axis] = loads.force[body, axis]
                    driven_moment[body, axis] = loads.moment[body, axis]

        # kick: momenta from half a step before to half a step after; the first is half a kick
        for body in range(n_bodies):
            if bodies.driven[body]:
                continue
            for axis in range(3):
                gained = 0.5 * dt * bodies.inverse_mass[body] * loads.force[body, axis]
                state.velocity[body, axis] = half_velocity[body, axis] + (gained if step > 0 else 0.0)
                half_velocity[body, axis] = state.velocity[body, axis] + gained
                kinematics.velocity[body, axis] = half_velocity[body, axis] + gained
                if step > 0:
                    momentum[body, axis] += 0.5 * dt * loads.moment[body, axis]
            spin_into(
                bodies.inverse_inertia[body],
                state.orientation[body],
                momentum[body],
                state.angular_velocity[body],
            )
            for axis in range(3):
                momentum[body, axis] += 0.5 * dt * loads.moment[body, axis]

        if _has_diverged(state.velocity):
            return DIVERGED, -1, step, rebuilds, loads.joint
        while next_time < times.size and times[next_time] < t + 0.5 * dt:
            offset = times[next_time] - t
            for body in range(n_bodies):
                for axis in range(3):
                    record.position[next_time, body, axis] = (
                        state.position[body, axis] + offset * state.velocity[body, axis]
                    )
                    slope = 2.0 * (half_velocity[body, axis] - state.velocity[body, axis]) / dt
                    record.velocity[next_time, body, axis] = state.velocity[body, axis] + (
                        0.0 if bodies.driven[body] else offset * slope
                    )
                    record.angular_velocity[next_time, body, axis] = state.angular_velocity[body, axis]
                    turn[axis] = offset * state.angular_velocity[body, axis]
                rotate_into(state.orientation[body], turn, record.orientation[next_time, body])
            energy = record.energy[next_time]
            energy[0] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
            energy[1] = potential_energy(bodies, state.position)
            energy[2] = loads.energy[ELASTIC]
            # a step's dashpot heat lasts to half a step ahead
            energy[3], energy[4] = most_friction, damping_heat - 0.5 * loads.energy[DAMPING]
            energy[5], energy[6] = 0.0, work
            record.joint_force[next_time] = loads.joint_force
            next_time += 1
            collapsed = find_collapsed(bodies, state, supported, drop_limit)
            if collapsed >= 0:
                return COLLAPSED, collapsed, step, rebuilds, loads.joint

        for body in range(n_bodies):
            if not bodies.driven[body]:
                drift_into(
                    bodies.inverse_inertia[body], half_velocity[body], momentum[body],
                    state.angular_velocity[body], dt,
                    state.position[body], state.orientation[body], half_spin[body],
                )  # fmt: skip
                # extrapolated half a step on, with the present moment still acting
                for axis in range(3):
                    turn[axis] = momentum[body, axis] + 0.5 * dt * loads.moment[body, axis]
                spin_into(bodies.inverse_inertia[body], state.orientation[body], turn, kinematics.spin[body])
    return COMPLETED, -1, n_steps, rebuilds, loads.joint
