"""Elastic stops fixed to the driven body, as penalty springs."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import kernel


@kernel
def stopper_forces_into(bodies, stoppers, state, loads):
    """Add the forces of closed stoppers to ``loads``; the elastic energy they hold is returned [J].

    A stopper is a plane across its signed axis, ``gap`` away from the body's point at the start,
    which travels and turns with the first driven body. With the closure ``c`` of the point beyond
    the gap it pushes the point back with ``stiffness * c`` and the driven body with the opposite.
    """
    energy = 0.0
    if stoppers.body.size == 0:
        return energy
    driven = np.argmax(bodies.driven)
    R, R_driven, R_start = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    rotation_matrix_into(bodies.home_orientation[driven], R_start)
    rotation_matrix_into(state.orientation[driven], R_driven)
    for stop in range(stoppers.body.size):
        body = stoppers.body[stop]
        rotation_matrix_into(bodies.home_orientation[body], R)
        reach_start = bodies.home[body] + R @ stoppers.point[stop] - bodies.home[driven]
        rotation_matrix_into(state.orientation[body], R)
        arm = R @ stoppers.point[stop]
        reach = state.position[body] + arm - state.position[driven]
        # axis and reach in the driven body's axes, where the stopper stands still
        axis = R_start.T @ stoppers.axis[stop]
        closure = -stoppers.gap[stop]
        for i in range(3):
            for j in range(3):
                closure += axis[i] * (R_driven[j, i] * reach[j] - R_start[j, i] * reach_start[j])
        if closure > 0.0:
            force = -stoppers.stiffness[stop] * closure * (R_driven @ axis)
            loads.force[body] += force
            loads.moment[body] += np.cross(arm, force)
            loads.force[driven] -= force
            loads.moment[driven] -= np.cross(reach, force)
            energy += 0.5 * stoppers.stiffness[stop] * closure * closure
    return energy
