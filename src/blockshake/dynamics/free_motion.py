"""Newton-Euler equations by leapfrog: momentum at half steps, pose at full steps, second order in the step."""

from blockshake.geometry.rotations import rotation_rows, turned
from blockshake.geometry.vectors import columns_product, matrix_product, put_into, rows_product
from blockshake.jit import kernel_without_allocation


@kernel_without_allocation
def _spin(inverse_inertia, q, angular_momentum):
    """Angular velocity ``R J^-1 R^T L`` of one body, see `spin_into`."""
    R = rotation_rows(q)
    return rows_product(R, matrix_product(inverse_inertia, columns_product(R, angular_momentum)))


@kernel_without_allocation
def spin_into(inverse_inertia, orientation, angular_momentum, out):
    """Angular velocity ``R J^-1 R^T L`` of one body, world frame, written into ``out`` [rad/s].

    ``inverse_inertia`` (3, 3) in body axes [1/(kg m2)]; ``orientation`` (4,);
    ``angular_momentum`` (3,) about the mass centre, world frame [kg m2/s].
    """
    put_into(_spin(inverse_inertia, orientation, angular_momentum), out)


@kernel_without_allocation
def drift_into(inverse_inertia, velocity, angular_momentum, spin_now, dt, position, orientation):
    """One body's pose a step later, from its momenta at half a step.

    ``inverse_inertia`` (3, 3) in body axes [1/(kg m2)]; ``velocity``, ``angular_momentum`` (3,) at half a step from
    now, world frame [m/s, kg m2/s]; ``spin_now`` (3,): angular velocity now [rad/s]; ``dt`` [s]. ``position`` (3,) and
    ``orientation`` (4,) are advanced in place.

    Notes
    -----
    Explicit midpoint in the rotation group, in the manner of Fincham (1992), Leapfrog rotational algorithms, Molecular
    Simulation 8: the orientation half a step ahead is predicted with ``spin_now`` and turns the angular momentum, which
    is exact, into the mean angular velocity of the step.
    """
    for axis in range(3):
        position[axis] += dt * velocity[axis]
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    half = 0.5 * dt
    ahead = turned(w, x, y, z, half * spin_now[0], half * spin_now[1], half * spin_now[2])
    s0, s1, s2 = _spin(inverse_inertia, ahead, angular_momentum)
    orientation[0], orientation[1], orientation[2], orientation[3] = turned(
        w, x, y, z, dt * s0, dt * s1, dt * s2
    )
