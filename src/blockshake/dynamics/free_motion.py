"""Newton-Euler equations by leapfrog: momentum at half steps, pose at full steps, second order in the step."""

import numpy as np

from blockshake.geometry.rotations import rotate_into
from blockshake.jit import kernel


@kernel
def spin_into(inverse_inertia, orientation, angular_momentum, out):
    """Angular velocity ``R J^-1 R^T L`` of one body, world frame, written into ``out`` [rad/s].

    ``inverse_inertia`` (3, 3) in body axes [1/(kg m2)]; ``orientation`` (4,);
    ``angular_momentum`` (3,) about the mass centre, world frame [kg m2/s].
    """
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    # rows of R^T: the body axes in the world frame
    e0 = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y))
    e1 = (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x))
    e2 = (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y))
    L, J = angular_momentum, inverse_inertia
    l0 = e0[0] * L[0] + e0[1] * L[1] + e0[2] * L[2]
    l1 = e1[0] * L[0] + e1[1] * L[1] + e1[2] * L[2]
    l2 = e2[0] * L[0] + e2[1] * L[1] + e2[2] * L[2]
    s0 = J[0, 0] * l0 + J[0, 1] * l1 + J[0, 2] * l2
    s1 = J[1, 0] * l0 + J[1, 1] * l1 + J[1, 2] * l2
    s2 = J[2, 0] * l0 + J[2, 1] * l1 + J[2, 2] * l2
    for i in range(3):
        out[i] = e0[i] * s0 + e1[i] * s1 + e2[i] * s2


@kernel
def drift_into(inverse_inertia, velocity, angular_momentum, spin_now, dt, position, orientation, spin):
    """One body's pose a step later, from its momenta at half a step.

    Parameters
    ----------
    inverse_inertia : float64 array, shape (3, 3)
        Body axes [1/(kg m2)].
    velocity, angular_momentum : float64 arrays, shape (3,)
        At half a step from now, world frame [m/s, kg m2/s].
    spin_now : float64 array, shape (3,)
        Angular velocity now [rad/s].
    dt : float
        [s]
    position, orientation : float64 arrays, shape (3,) and (4,)
        Advanced by ``dt`` in place.
    spin : float64 array, shape (3,)
        Overwritten with the angular velocity at half a step [rad/s].

    Notes
    -----
    Explicit midpoint in the rotation group, in the manner of Fincham (1992), Leapfrog rotational algorithms, Molecular
    Simulation 8: the orientation half a step ahead is predicted with ``spin_now`` and turns the angular momentum, which
    is exact, into the mean angular velocity of the step.
    """
    half_turn, middle = np.empty(3), np.empty(4)
    for axis in range(3):
        position[axis] += dt * velocity[axis]
        half_turn[axis] = 0.5 * dt * spin_now[axis]
    rotate_into(orientation, half_turn, middle)
    spin_into(inverse_inertia, middle, angular_momentum, spin)
    for axis in range(3):
        half_turn[axis] = dt * spin[axis]
    rotate_into(orientation, half_turn, orientation)
