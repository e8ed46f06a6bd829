import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.dynamics.free_motion import drift_into, spin_into

INERTIA = np.array([1.0, 2.0, 3.0])  # kg m2
SPIN = np.array([0.3, 0.0, 2.0])  # rad/s in body axes at the start


def test_quaternions_stay_unit_and_continuous():
    """A body that tumbles for 3 s, its momentum never touched."""
    inverse, dt = np.diag(1.0 / INERTIA), 1e-3
    position, orientation = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    velocity, momentum, spin = np.array([1.0, 2.0, 3.0]), INERTIA * SPIN, np.empty(3)
    quaternions = np.empty((3000, 4))
    for step in range(3000):
        spin_into(inverse, orientation, momentum, spin)
        quaternions[step] = orientation
        drift_into(inverse, velocity, momentum, spin, dt, position, orientation)
    assert position == pytest.approx(3.0 * velocity, rel=1e-12)
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1.0, atol=1e-14)
    assert (quaternions[1:] * quaternions[:-1]).sum(axis=1).min() > 0.99


def test_a_turn_about_a_principal_axis_is_exact():
    """The mean angular velocity of each step is the constant one: no error but rounding."""
    inverse = np.diag(1.0 / INERTIA)
    orientation, spin = np.array([1.0, 0.0, 0.0, 0.0]), np.empty(3)
    momentum = np.array([0.0, 0.0, 3.0 * 1.5])
    for _ in range(1000):
        spin_into(inverse, orientation, momentum, spin)
        drift_into(inverse, np.zeros(3), momentum, spin, 1e-3, np.zeros(3), orientation)
    np.testing.assert_allclose(orientation, [np.cos(0.75), 0.0, 0.0, np.sin(0.75)], atol=1e-13)


def test_the_spin_is_the_tensors():
    rng = np.random.default_rng(5)
    A = rng.normal(size=(3, 3))
    inverse, momentum = A @ A.T, rng.normal(size=3)
    rotation = Rotation.from_rotvec([0.4, -1.0, 0.3])
    out = np.empty(3)
    spin_into(inverse, rotation.as_quat(scalar_first=True), momentum, out)
    R = rotation.as_matrix()
    np.testing.assert_allclose(out, R @ inverse @ R.T @ momentum, rtol=1e-13)
