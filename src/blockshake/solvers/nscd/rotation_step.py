"""One step of a rigid body's rotation that keeps angular momentum, and energy at theta 0.5."""

import numpy as np

from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.jit import kernel

_MAX_ITERATIONS = 50
_ROUNDING = 1e-15


@kernel
def _rotate_vector_into(rotation, x, out):
    """Vector ``x`` turned by a rotation vector [rad], by Rodrigues' formula."""
    rx, ry, rz = rotation[0], rotation[1], rotation[2]
    angle = np.sqrt(rx * rx + ry * ry + rz * rz)
    # series near zero, where the quotients are 0/0
    s = 1.0 - angle * angle / 6.0 if angle < 1e-4 else np.sin(angle) / angle
    half = np.sin(0.5 * angle)
    c = 0.5 - angle * angle / 24.0 if angle < 1e-4 else 2.0 * half * half / (angle * angle)
    ux, uy, uz = ry * x[2] - rz * x[1], rz * x[0] - rx * x[2], rx * x[1] - ry * x[0]
    out[0] = x[0] + s * ux + c * (ry * uz - rz * uy)
    out[1] = x[1] + s * uy + c * (rz * ux - rx * uz)
    out[2] = x[2] + s * uz + c * (rx * uy - ry * ux)


@kernel
def turn_into(
    orientation, spin, inertia, inverse_inertia, torque, dt, theta, new_orientation, new_spin, mean_spin
):
    """Orientation and angular velocity at the end of a step.

    Parameters
    ----------
    orientation : float64 array, shape (4,)
        Unit quaternion at the start.
    spin : float64 array, shape (3,)
        Angular velocity at the start, world frame [rad/s].
    inertia, inverse_inertia : float64 arrays, shape (3, 3)
        Body frame [kg m2, 1/(kg m2)].
    torque : float64 array, shape (3,)
        Impulse moment of the step about the mass centre, world frame [N m s].
    dt, theta : float
        Step [s] and weight of the end of the step.
    new_orientation, new_spin : float64 arrays, shapes (4,) and (3,)
        Overwritten; ``new_orientation`` must not be ``orientation``.
    mean_spin : float64 array, shape (3,)
        Overwritten: mean of the two angular velocities, taken in the body frame and turned into the
        world by the orientation at the start [rad/s].

    Notes
    -----
    The midpoint scheme with convected velocities of Simo and Wong (1991): ``R1 J W1 = R0 J W0 +
    torque`` with ``R1 = R0 exp(dt W)`` and ``W = (1 - theta) W0 + theta W1`` in the body frame, by fixed-point
    iteration. As ``exp(dt W)`` leaves ``W`` alone, the kinetic energy changes at theta 0.5 by exactly
    ``torque`` times ``mean_spin``.
    """
    R = np.empty((3, 3))
    rotation_matrix_into(orientation, R)
    start = R.T @ spin
    target = inertia @ start + R.T @ torque
    end = inverse_inertia @ target
    turned, rotation = np.empty(3), np.empty(3)
    for _ in range(_MAX_ITERATIONS):
        for axis in range(3):
            rotation[axis] = -dt * ((1.0 - theta) * start[axis] + theta * end[axis])
        _rotate_vector_into(rotation, target, turned)
        following = inverse_inertia @ turned
        change, size = 0.0, 0.0
        for axis in range(3):
            change = max(change, abs(following[axis] - end[axis]))
            size = max(size, abs(following[axis]))
        end[:] = following
        if change <= _ROUNDING * size:
            break
    for axis in range(3):
        rotation[axis] = dt * ((1.0 - theta) * start[axis] + theta * end[axis])
    rotate_into(orientation, R @ rotation, new_orientation)
    mean_spin[:] = R @ (0.5 * (start + end))
    rotation_matrix_into(new_orientation, R)
    new_spin[:] = R @ end
