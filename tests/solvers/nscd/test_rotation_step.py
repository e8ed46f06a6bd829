import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.nscd.step import turn_into

# fixed-point iteration to rounding, added up over the steps
ROUNDING = 1e-11


def spin_freely(J, spin, steps, dt=1e-3, torque=(0.0, 0.0, 0.0), theta=0.5):
    orientation = np.array([1.0, 0.0, 0.0, 0.0])
    spin = np.array(spin, dtype=float)
    work = 0.0
    for _ in range(steps):
        new_orientation, new_spin, mean = np.empty(4), np.empty(3), np.empty(3)
        turn_into(
            orientation,
            spin,
            J,
            np.linalg.inv(J),
            np.array(torque),
            dt,
            theta,
            new_orientation,
            new_spin,
            mean,
        )
        work += mean @ torque
        orientation, spin = new_orientation, new_spin
    R = rotation_matrices(orientation)
    return R @ J @ R.T @ spin, 0.5 * spin @ R @ J @ R.T @ spin, work


def test_free_tumbling_keeps_angular_momentum_and_energy():
    # Simo and Wong (1991); the middle axis is unstable, so that the body really tumbles
    J = np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.05], [0.0, 0.05, 3.0]])
    spin = np.array([0.01, 4.0, 0.02])
    momentum, energy, _ = spin_freely(J, spin, 5000)
    np.testing.assert_allclose(momentum, J @ spin, rtol=0, atol=ROUNDING * np.linalg.norm(J @ spin))
    np.testing.assert_allclose(energy, 0.5 * spin @ J @ spin, rtol=ROUNDING)


def test_torque_adds_its_impulse_and_its_work():
    J = np.diag([1.0, 2.0, 3.0])
    spin, torque = np.array([1.0, 2.0, 0.5]), np.array([1e-3, -2e-3, 5e-4])
    momentum, energy, work = spin_freely(J, spin, 1000, torque=torque)
    np.testing.assert_allclose(momentum, J @ spin + 1000 * torque, rtol=1e-10)
    np.testing.assert_allclose(energy - 0.5 * spin @ J @ spin, work, rtol=1e-9)


def test_rotation_about_a_principal_axis_is_exact():
    orientation, spin, mean = np.empty(4), np.empty(3), np.empty(3)
    J = np.diag([1.0, 2.0, 3.0])
    turn_into(
        np.array([1.0, 0, 0, 0]),
        np.array([0, 1.5, 0]),
        J,
        np.linalg.inv(J),
        np.zeros(3),
        0.4,
        0.5,
        orientation,
        spin,
        mean,
    )
    np.testing.assert_allclose(orientation, [np.cos(0.3), 0, np.sin(0.3), 0], atol=1e-15)
    np.testing.assert_allclose(spin, [0, 1.5, 0], atol=1e-15)
