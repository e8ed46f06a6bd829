"""Elastic stops fixed to the driven body, as compliant contacts without friction."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.jit import kernel


@kernel
def place_stoppers_into(bodies, stoppers, base, step, dt, theta, contacts):
    """Write the stoppers, as contacts of the driven body ``base``, into the last rows.

    The law of an implicit spring that only pushes, ``u_n + bound + p / s >= 0`` with ``s = theta dt^2 k``, times ``s
    / (s + m)``, m the mass of the body: so a stop without stiffness has the law ``p / m >= 0``, and no impulse.
    """
    first = contacts.gap.size - stoppers.body.size
    toward = np.empty(3)
    for stopper in range(stoppers.body.size):
        row, body = first + stopper, stoppers.body[stopper]
        contacts.body_a[row], contacts.body_b[row] = base, body
        contacts.stopper[row] = stopper
        contacts.home[row] = stoppers.point[stopper]
        contacts.friction[row] = 0.0
        admittance = theta * dt * dt * stoppers.stiffness[stopper]
        contacts.share[row] = admittance / (admittance + bodies.mass[body])
        contacts.compliance[row] = 1.0 / (admittance + bodies.mass[body])
        closed = closure_into(
            bodies, stoppers, stopper, base, step.detection, contacts.arm_a[row], contacts.arm_b[row], toward
        )
        contacts.gap[row] = -closed
        contacts.basis[row, 0] = -toward


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
