"""The time loop of LS-DEM: detect, force, kick, record, drift."""

import numpy as np

from blockshake.dynamics.collapse import find_collapsed
from blockshake.dynamics.free_motion import drift_into, spin_into
from blockshake.dynamics.motion import PITCH
from blockshake.dynamics.system import (
    CONTACT_LOSS,
    ELASTIC,
    FRICTION_LOSS,
    INPUT,
    KINETIC,
    POTENTIAL,
    VISCOUS_LOSS,
    kinetic_energy,
    place_driven_into,
    potential_energy,
)
from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.geometry.vectors import copy_into, cross
from blockshake.jit import inner_kernel, kernel_without_allocation, loop_kernel
from blockshake.solvers.external_forces import closure_into, external_wrenches_into
from blockshake.solvers.ground import ground_at_start, move_ground_into
from blockshake.solvers.ls_dem.contact.candidates import find_candidates, lists_expired
from blockshake.solvers.ls_dem.contact.contact_forces import (
    SPRING_ENERGY,
    STEP_DASHPOT_HEAT,
    STEP_EXTERNAL_WORK,
    STEP_FRICTION_HEAT,
    clear_loads,
    contact_forces_into,
    no_loads,
)
from blockshake.solvers.ls_dem.contact.relative_pose import keep_poses
from blockshake.solvers.ls_dem.progress import (
    DASHPOT_HEAT,
    FRICTION_HEAT,
    INPUT_WORK,
    MOST_FRICTION_HEAT,
    SEARCHES,
)
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

# Code of `_advance` with those of a run: a node outside the lists may touch by now
_LISTS_EXPIRED = -1


def integrate(assembly, times, pause, progress, candidates, joints, record):
    """Run LS-DEM from where ``progress`` stands to its last step, or to a pause.

    Parameters
    ----------
    assembly, times : Assembly, float64 array, shape (n_times,)
        When to record, increasing from 0 [s].
    pause : int
        Step before which to pause.
    progress, candidates, joints, record : LeapfrogProgress, Candidates, NearPairs, RunRecord
        The progress is changed in place; near nodes have the shear springs of the step before; the record is filled
        from the next row on.

    Returns
    -------
    code, culprit : int
        `blockshake.solvers.record`; body that collapsed or ran away, else -1.
    candidates, joints, record
        To go on with.

    Notes
    -----
    Leapfrog (velocity Verlet) of the Newton-Euler equations: momenta at half steps, poses at full steps, of second
    order with damping too (see `node_force`). Heat, input work and elastic energy are summed so that their balance
    closes but for the error of the scheme.
    """
    bodies = assembly.bodies
    n_bodies = len(bodies.mass)
    ground, turn, external = ground_at_start(assembly.table), np.zeros(3), np.zeros((n_bodies, 6))
    searched = False
    while True:
        record = with_room(record, len(joints.slip))
        loads = no_loads(n_bodies, joints)
        code, culprit = _advance(
            assembly, times, pause, progress, candidates, record, searched, ground, turn, external, loads
        )
        if code != _LISTS_EXPIRED:
            return code, culprit, candidates, joints, record
        candidates, joints = find_candidates(
            assembly.surfaces, bodies.driven, progress.poses, progress.state.orientation, assembly.skin, candidates,
            joints,
        )  # fmt: skip
        progress.clock[SEARCHES] += 1
        searched = True


@loop_kernel
def _advance(assembly, times, pause, progress, candidates, record, searched, ground, turn, external, loads):
    """Steps until the lists expire, or the run ends or pauses; code and culprit as in `integrate`, or `_LISTS_EXPIRED`.

    ``searched``: whether the lists were made for the poses of the next step. ``turn`` (3,), ``external`` (n_bodies, 6)
    [N, N m] and ``loads`` are worked in; ``external`` is zero where there are no external forces.
    """
    bodies, surfaces, interfaces, stoppers, forces, _, supported, drop_limit, skin, dt, n_steps = assembly
    state, poses, clock, audit = progress.state, progress.poses, progress.clock, progress.audit
    now = ground.displacement
    while clock[STEP] <= n_steps:
        step = clock[STEP]
        if step == pause:
            return PAUSED, -1
        t = step * dt
        move_ground_into(ground, t)
        place_driven_into(bodies, now, ground.velocity, state)
        for body in range(bodies.mass.size):
            rotation_matrix_into(state.orientation[body], poses.rotation[body])
        if step == 0:
            copy_into(now, progress.ground)
            keep_poses(poses)
        # the lists hold until two bodies together may have moved by the skin: then Python makes them anew
        if not searched and (
            step == 0
            or lists_expired(candidates, surfaces, bodies.driven, state.position, state.orientation, skin)
        ):
            return _LISTS_EXPIRED, -1
        searched = False

        clear_loads(bodies, loads)
        # the first force sees no motion before it: the springs of the start hold as they are
        contact_forces_into(candidates, surfaces, interfaces, poses, dt if step > 0 else 0.0, loads)
        keep_poses(poses)
        loads.energy[SPRING_ENERGY] += stopper_forces_into(bodies, stoppers, state, loads)
        external_loads_into(forces, state, t, external, loads)
        _account_into(bodies, loads, now, progress)

        # momenta go from t - dt/2 to t + dt/2; at t itself they are the state that is recorded
        _kick(bodies, loads, dt, step > 0, progress)
        loads.energy[STEP_EXTERNAL_WORK] = dt * external_power(forces, external, state)
        # the first kick is half a step's
        audit[INPUT_WORK] += loads.energy[STEP_EXTERNAL_WORK] * (1.0 if step > 0 else 0.5)
        runaway = find_diverged(state)
        if runaway >= 0:
            return DIVERGED, runaway
        while clock[NEXT_RECORD] < times.size and times[clock[NEXT_RECORD]] < t + 0.5 * dt:
            row, offset = clock[NEXT_RECORD] - record.first[0], times[clock[NEXT_RECORD]] - t
            _record_into(bodies, loads, offset, dt, progress, turn, row, record)
            clock[NEXT_RECORD] += 1
            collapsed = find_collapsed(bodies, state, supported, drop_limit)
            if collapsed >= 0:
                return COLLAPSED, collapsed
        _drift(bodies, dt, progress)
        clock[STEP] += 1
    return COMPLETED, -1


@kernel_without_allocation
def _account_into(bodies, loads, now, progress):
    """Heat of the step, and work of the driven bodies: their mean force since the step before times their motion."""
    audit, ground = progress.audit, progress.ground
    audit[FRICTION_HEAT] += loads.energy[STEP_FRICTION_HEAT]
    # a node that lets go while its slip reverses gives back some microjoules of a step's error
    audit[MOST_FRICTION_HEAT] = max(audit[MOST_FRICTION_HEAT], audit[FRICTION_HEAT])
    audit[DASHPOT_HEAT] += loads.energy[STEP_DASHPOT_HEAT]
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            for axis in range(3):
                moved = now[axis] - ground[axis]
                turned = now[PITCH] - ground[PITCH] if axis == 1 else 0.0
                audit[INPUT_WORK] -= (
                    0.5 * (loads.force[body, axis] + progress.driven_force[body, axis]) * moved
                )
                audit[INPUT_WORK] -= (
                    0.5 * (loads.moment[body, axis] + progress.driven_moment[body, axis]) * turned
                )
                progress.driven_force[body, axis] = loads.force[body, axis]
                progress.driven_moment[body, axis] = loads.moment[body, axis]
    copy_into(now, ground)


@kernel_without_allocation
def _kick(bodies, loads, dt, under_way, progress):
    """Newton-Euler equations: momenta from half a step before to half a step after; the first is half a kick."""
    state, half_velocity, momentum = progress.state, progress.half_velocity, progress.half_momentum
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            continue
        for axis in range(3):
            gained = 0.5 * dt * bodies.inverse_mass[body] * loads.force[body, axis]
            state.velocity[body, axis] = half_velocity[body, axis] + (gained if under_way else 0.0)
            half_velocity[body, axis] = state.velocity[body, axis] + gained
            if under_way:
                momentum[body, axis] += 0.5 * dt * loads.moment[body, axis]
        spin_into(
            bodies.inverse_inertia[body],
            state.orientation[body],
            momentum[body],
            state.angular_velocity[body],
        )
        for axis in range(3):
            momentum[body, axis] += 0.5 * dt * loads.moment[body, axis]


@kernel_without_allocation
def _drift(bodies, dt, progress):
    """Poses a step on."""
    state = progress.state
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            drift_into(
                bodies.inverse_inertia[body], progress.half_velocity[body], progress.half_momentum[body],
                state.angular_velocity[body], dt, state.position[body], state.orientation[body],
            )  # fmt: skip


@inner_kernel
def _record_into(bodies, loads, offset, dt, progress, turn, row, record):
    """State and audit at a time ``offset`` from the step, at most half a step away, in one row of the record."""
    state, audit = progress.state, progress.audit
    for body in range(bodies.mass.size):
        for axis in range(3):
            velocity = state.velocity[body, axis]
            slope = 0.0 if bodies.driven[body] else 2.0 * (progress.half_velocity[body, axis] - velocity) / dt
            record.position[row, body, axis] = state.position[body, axis] + offset * velocity
            record.velocity[row, body, axis] = velocity + offset * slope
            record.angular_velocity[row, body, axis] = state.angular_velocity[body, axis]
            turn[axis] = offset * state.angular_velocity[body, axis]
        rotate_into(state.orientation[body], turn, record.orientation[row, body])
    energy = record.energy[row]
    energy[KINETIC] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
    energy[POTENTIAL] = potential_energy(bodies, state.position)
    energy[ELASTIC] = loads.energy[SPRING_ENERGY]
    energy[FRICTION_LOSS] = audit[MOST_FRICTION_HEAT]
    # a step's dashpot heat and external work last to half a step ahead
    energy[CONTACT_LOSS] = audit[DASHPOT_HEAT] - 0.5 * loads.energy[STEP_DASHPOT_HEAT]
    energy[VISCOUS_LOSS] = 0.0
    energy[INPUT] = audit[INPUT_WORK] - 0.5 * loads.energy[STEP_EXTERNAL_WORK]
    copy_into(loads.joints.force, record.joint_force[row])


@inner_kernel
def stopper_forces_into(bodies, stoppers, state, loads):
    """Add the forces of closed stoppers, if any, to ``loads``; the elastic energy they hold is returned [J].

    With the closure ``c`` of its body's point beyond the gap, see `closure_into`, a stopper pushes the point back with
    ``stiffness * c`` and the first driven body with the opposite.
    """
    energy = 0.0
    if stoppers is None:
        return energy
    driven = np.argmax(bodies.driven)
    reach, arm, toward = np.empty(3), np.empty(3), np.empty(3)
    for stopper in range(stoppers.body.size):
        closure = closure_into(bodies, stoppers, stopper, driven, state, reach, arm, toward)
        if closure > 0.0:
            body, stiffness = stoppers.body[stopper], stoppers.stiffness[stopper]
            size = -stiffness * closure
            force = size * toward[0], size * toward[1], size * toward[2]
            of_body, of_driven = cross(arm, force), cross(reach, force)
            for axis in range(3):
                loads.force[body, axis] += force[axis]
                loads.moment[body, axis] += of_body[axis]
                loads.force[driven, axis] -= force[axis]
                loads.moment[driven, axis] -= of_driven[axis]
            energy += 0.5 * stiffness * closure * closure
    return energy


@inner_kernel
def external_loads_into(forces, state, time, external, loads):
    """Add external forces, if any, to ``loads``; ``external`` (n_bodies, 6) is then overwritten."""
    if forces is None:
        return
    external_wrenches_into(forces, state, time, 0.0, external)
    for body in range(external.shape[0]):
        for axis in range(3):
            loads.force[body, axis] += external[body, axis]
            loads.moment[body, axis] += external[body, 3 + axis]


@inner_kernel
def external_power(forces, external, state):
    """Power of external forces, if any, on bodies that move as ``state`` has it [W]."""
    power = 0.0
    if forces is None:
        return power
    for body in range(external.shape[0]):
        for axis in range(3):
            power += external[body, axis] * state.velocity[body, axis]
            power += external[body, 3 + axis] * state.angular_velocity[body, axis]
    return power
