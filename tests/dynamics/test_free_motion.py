import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipk

from blockshake.dynamics.free_motion import drift_into, spin_into

INERTIA = np.array([1.0, 2.0, 3.0])  # kg m2, ascending as in Landau & Lifshitz
SPIN = np.array([0.3, 0.0, 2.0])  # rad/s in body axes at the start; M^2 > 2 E I2 holds
DURATION = 3.0  # s, more than one period of the polhode


def _tumble(dt):
    """Body-frame angular velocity, orientation and energy at every step; the momentum is never touched."""
    n = round(DURATION / dt)
    inverse = np.diag(1.0 / INERTIA)
    position, orientation = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    momentum, spin = INERTIA * SPIN, np.empty(3)
    quaternions, spins = np.empty((n + 1, 4)), np.empty((n + 1, 3))
    for step in range(n + 1):
        spin_into(inverse, orientation, momentum, spin)
        quaternions[step], spins[step] = orientation, spin
        drift_into(inverse, np.array([1.0, 2.0, 3.0]), momentum, spin, dt, position, orientation)
    assert position == pytest.approx((n + 1) * dt * np.array([1.0, 2.0, 3.0]), rel=1e-12)
    body = Rotation.from_quat(quaternions, scalar_first=True).inv().apply(spins)
    return np.arange(n + 1) * dt, body, quaternions


def _elliptic(t):
    """Landau & Lifshitz, Mechanics, section 37: the asymmetrical top, angular velocity in body axes."""
    (a, b, c), energy, square = INERTIA, (INERTIA * SPIN**2).sum(), ((INERTIA * SPIN) ** 2).sum()
    # energy is 2 E
    rate = np.sqrt((c - b) * (square - energy * a) / (a * b * c))
    m = (b - a) * (energy * c - square) / ((c - b) * (square - energy * a))
    sn, cn, dn, _ = ellipj(rate * t, m)
    assert 4.0 * ellipk(m) / rate < DURATION + 2.0
    return np.column_stack(
        [
            np.sqrt((energy * c - square) / (a * (c - a))) * cn,
            np.sqrt((energy * c - square) / (b * (c - b))) * sn,
            np.sqrt((square - energy * a) / (c * (c - a))) * dn,
        ]
    )


def test_the_elliptic_solution_obeys_eulers_equations():
    """The reference above, by its own integral over the first second: I2 w2' = (I3 - I1) w3 w1."""
    gained, _ = quad(lambda t: np.prod(_elliptic(np.array([t]))[0, [0, 2]]) * (3.0 - 1.0) / 2.0, 0.0, 1.0)
    assert _elliptic(np.array([1.0]))[0, 1] == pytest.approx(gained, rel=1e-9)


def test_free_tumbling_follows_the_elliptic_solution_to_second_order():
    errors = []
    for dt in (4e-3, 2e-3, 1e-3):
        t, body, _ = _tumble(dt)
        errors.append(np.abs(body - _elliptic(t)).max())
    assert errors[-1] < 1e-4  # (|w| dt)^2 of 2 rad/s, over 6 rad of turning
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.1)


def test_the_orientation_keeps_the_spins_energy_to_second_order():
    """2 E = w . L, and L is constant by construction; so E tells the error of the orientation."""
    errors = []
    for dt in (4e-3, 2e-3, 1e-3):
        _, body, _ = _tumble(dt)
        energy = 0.5 * (INERTIA * body**2).sum(axis=1)
        errors.append(np.abs(energy / energy[0] - 1.0).max())
    assert errors[-1] < 1e-5
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert np.log2(errors[1] / errors[2]) > 1.8


def test_quaternions_stay_unit_and_continuous():
    _, _, quaternions = _tumble(1e-3)
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
