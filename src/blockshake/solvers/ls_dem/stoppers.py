"""Elastic stops fixed to the driven body, as penalty springs."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import kernel


@kernel
def stopper_forces_into(bodies, stoppers, state, loads):
    """Add the forces of closed stoppers to ``loads``; the elastic energy they hold is returned [J].

    A stopper stands on the side of its signed axis, ``gap`` away at the start, and travels with
    the first driven body. With the closure ``c`` of the body's point beyond the gap it pushes the
    point back with ``stiffness * c`` and the driven body with the opposite.
    """
    energy = 0.0
    if stoppers.body.size == 0:
        return energy
    driven = np.argmax(bodies.driven)
    R = np.empty((3, 3))
    for stop in range(stoppers.body.size):
        body, axis = stoppers.body[stop], stoppers.axis[stop]
        rotation_matrix_into(bodies.home_orientation[body], R)
        arm_start = R @ stoppers.point[stop]
        rotation_matrix_into(state.orientation[body], R)
        arm = R @ stoppers.point[stop]
        closure = -stoppers.gap[stop]
        for i in range(3):
            moved = state.position[body, i] + arm[i] - bodies.home[body, i] - arm_start[i]
            closure += axis[i] * (moved - (state.position[driven, i] - bodies.home[driven, i]))
        if closure > 0.0:
            force = -stoppers.stiffness[stop] * closure * axis
            reach = state.position[body] + arm - state.position[driven]
            loads.force[body] += force
            loads.moment[body] += np.cross(arm, force)
            loads.force[driven] -= force
            loads.moment[driven] -= np.cross(reach, force)
            energy += 0.5 * stoppers.stiffness[stop] * closure * closure
    return energy
