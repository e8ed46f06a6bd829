"""Elastic stops fixed to the driven body: where a stop is, and by how much its body closes it."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import kernel


@kernel
def closure_into(bodies, stoppers, stopper, base, state, reach, arm, toward):
    """Closure of a stopper beyond its gap [m], negative while open.

    A stopper is a plane across its signed axis, ``gap`` away from the body's point at the start, that travels
    and turns with the driven body ``base``.

    Parameters
    ----------
    bodies : Bodies
    stoppers : Stoppers
    stopper, base : int
    state : State
        Poses.
    reach, arm : float64 arrays, shape (3,)
        Overwritten: the point seen from the mass centres of the driven body and of its own, world frame [m].
    toward : float64 array, shape (3,)
        Overwritten: the signed axis as it has turned, world frame.
    """
    body = stoppers.body[stopper]
    R, R_base, R_start = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    rotation_matrix_into(bodies.home_orientation[body], R)
    rotation_matrix_into(bodies.home_orientation[base], R_start)
    reach_start = bodies.home[body] + R @ stoppers.point[stopper] - bodies.home[base]
    axis = R_start.T @ stoppers.axis[stopper]
    rotation_matrix_into(state.orientation[body], R)
    rotation_matrix_into(state.orientation[base], R_base)
    arm[:] = R @ stoppers.point[stopper]
    reach[:] = state.position[body] + arm - state.position[base]
    toward[:] = R_base @ axis
    # in the driven body's axes, where the stopper stands still
    return np.dot(axis, R_base.T @ reach - R_start.T @ reach_start) - stoppers.gap[stopper]
