"""Leapfrog of rigid bodies: momentum at half steps, pose at full steps, second order in the step."""

import numpy as np

from blockshake.geometry.rotations import rotate_into, rotation_matrix_into
from blockshake.jit import kernel


@kernel
def spin_into(inverse_inertia, orientation, angular_momentum, out):
    """Angular velocity ``R J^-1 R^T L`` of one body, world frame, written into ``out`` [rad/s].

    ``inverse_inertia`` (3, 3) in body axes [1/(kg m2)]; ``orientation`` (4,);
    ``angular_momentum`` (3,) about the mass centre, world frame [kg m2/s].
    """
    R, local = np.empty((3, 3)), np.zeros(3)
    rotation_matrix_into(orientation, R)
    for i in range(3):
        for j in range(3):
            local[i] += R[j, i] * angular_momentum[j]
    for i in range(3):
        out[i] = 0.0
        for j in range(3):
            turned = (
                inverse_inertia[j, 0] * local[0]
                + inverse_inertia[j, 1] * local[1]
                + inverse_inertia[j, 2] * local[2]
            )
            out[i] += R[i, j] * turned


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
    Explicit midpoint in the rotation group, in the manner of Fincham (1992), Leapfrog rotational
    algorithms, Molecular Simulation 8: the orientation half a step ahead is predicted with
    ``spin_now`` and turns the angular momentum, which is exact, into the mean angular velocity of
    the step.
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
