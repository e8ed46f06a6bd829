"""One step of a rigid body's rotation that keeps angular momentum, and energy at theta 0.5."""

import numpy as np

from blockshake.geometry.rotations import rotate_into, rotation_rows
from blockshake.jit import borrowing_kernel
from blockshake.solvers.vectors import columns_product, matrix_product, put_into, rows_product

_MAX_ITERATIONS = 50
_ROUNDING = 1e-15


@borrowing_kernel
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


@borrowing_kernel
def _weighted(start, end, theta, factor):
    """``factor`` times the mean of two vectors, the second with weight ``theta``."""
    return (
        factor * ((1.0 - theta) * start[0] + theta * end[0]),
        factor * ((1.0 - theta) * start[1] + theta * end[1]),
        factor * ((1.0 - theta) * start[2] + theta * end[2]),
    )


@borrowing_kernel
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
