import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.nscd.step import turn_into


def _turned(orientation, spin, J, torque, dt):
    """Orientation, spin and mean spin after a step at theta 0.5."""
    new_orientation, new_spin, mean = np.empty(4), np.empty(3), np.empty(3)
    turn_into(orientation, spin, J, np.linalg.inv(J), torque, dt, 0.5, new_orientation, new_spin, mean)
    return new_orientation, new_spin, mean


def test_torque_adds_its_impulse_and_its_work():
    J = np.diag([1.0, 2.0, 3.0])
    start, torque = np.array([1.0, 2.0, 0.5]), np.array([1e-3, -2e-3, 5e-4])
    orientation, spin, work = np.array([1.0, 0.0, 0.0, 0.0]), start, 0.0
    for _ in range(1000):
        orientation, spin, mean = _turned(orientation, spin, J, torque, 1e-3)
        work += mean @ torque
    R = rotation_matrices(orientation)
    momentum = R @ J @ R.T @ spin
    np.testing.assert_allclose(momentum, J @ start + 1000 * torque, rtol=1e-10)
    np.testing.assert_allclose(0.5 * spin @ momentum - 0.5 * start @ J @ start, work, rtol=1e-9)


def test_rotation_about_a_principal_axis_is_exact():
    upright, spin = np.array([1.0, 0, 0, 0]), np.array([0, 1.5, 0])
    orientation, spin, _ = _turned(upright, spin, np.diag([1.0, 2.0, 3.0]), np.zeros(3), 0.4)
    np.testing.assert_allclose(orientation, [np.cos(0.3), 0, np.sin(0.3), 0], atol=1e-15)
    np.testing.assert_allclose(spin, [0, 1.5, 0], atol=1e-15)
