"""Newton-Euler equations by leapfrog: momentum at half steps, pose at full steps, second order in the step."""

from blockshake.geometry.rotations import turned
from blockshake.jit import borrowing_kernel, inline_kernel


@inline_kernel
def spin(J, w, x, y, z, L0, L1, L2):
    """Angular velocity of one body from its orientation and angular momentum, number by number; see `spin_into`."""
    # rows of R^T: the body axes in the world frame
    e00, e01, e02 = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    e10, e11, e12 = 2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)
    e20, e21, e22 = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
    l0 = e00 * L0 + e01 * L1 + e02 * L2
    l1 = e10 * L0 + e11 * L1 + e12 * L2
    l2 = e20 * L0 + e21 * L1 + e22 * L2
    s0 = J[0, 0] * l0 + J[0, 1] * l1 + J[0, 2] * l2
    s1 = J[1, 0] * l0 + J[1, 1] * l1 + J[1, 2] * l2
    s2 = J[2, 0] * l0 + J[2, 1] * l1 + J[2, 2] * l2
    return e00 * s0 + e10 * s1 + e20 * s2, e01 * s0 + e11 * s1 + e21 * s2, e02 * s0 + e12 * s1 + e22 * s2


@borrowing_kernel
def spin_into(inverse_inertia, orientation, angular_momentum, out):
    """Angular velocity ``R J^-1 R^T L`` of one body, world frame, written into ``out`` [rad/s].

    ``inverse_inertia`` (3, 3) in body axes [1/(kg m2)]; ``orientation`` (4,);
    ``angular_momentum`` (3,) about the mass centre, world frame [kg m2/s].
    """
    q, L = orientation, angular_momentum
    out[0], out[1], out[2] = spin(inverse_inertia, q[0], q[1], q[2], q[3], L[0], L[1], L[2])


@borrowing_kernel
def drift_into(inverse_inertia, velocity, angular_momentum, spin_now, dt, position, orientation):
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

    Notes
    -----
    Explicit midpoint in the rotation group, in the manner of Fincham (1992), Leapfrog rotational algorithms, Molecular
    Simulation 8: the orientation half a step ahead is predicted with ``spin_now`` and turns the angular momentum, which
    is exact, into the mean angular velocity of the step.
    """
    for axis in range(3):
        position[axis] += dt * velocity[axis]
    w, x, y, z = orientation[0], orientation[1], orientation[2], orientation[3]
    half, L = 0.5 * dt, angular_momentum
    hw, hx, hy, hz = turned(w, x, y, z, half * spin_now[0], half * spin_now[1], half * spin_now[2])
    s0, s1, s2 = spin(inverse_inertia, hw, hx, hy, hz, L[0], L[1], L[2])
    orientation[0], orientation[1], orientation[2], orientation[3] = turned(
        w, x, y, z, dt * s0, dt * s1, dt * s2
    )
