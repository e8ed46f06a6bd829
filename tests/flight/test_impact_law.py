"""Restitution and ratio of impulses, from an impulse that is known."""

import numpy as np
import pytest

from blockshake_flight.impacts import impact_law

INERTIA = np.diag([2e-4, 5e-4, 3e-4])  # m2
ARM = np.array([0.02, -0.01, -0.03])
CAME, SPIN = np.array([0.4, -0.1, -1.5]), np.array([3.0, -8.0, 1.0])


def _after(impulse):
    """Velocity and spin after an impulse per mass at the contact (Newton and Euler)."""
    return CAME + impulse, SPIN + np.linalg.solve(INERTIA, np.cross(ARM, impulse))


def _impulse(restitution, ratio):
    """Impulse in a direction of a given ratio that reverses this share of the contact's approach."""
    along = np.array([-0.8 * ratio, 0.6 * ratio, 1.0])
    gained = (along + np.cross(np.linalg.solve(INERTIA, np.cross(ARM, along)), ARM))[2]
    return -(1.0 + restitution) * (CAME + np.cross(SPIN, ARM))[2] / gained * along


@pytest.mark.parametrize(("restitution", "ratio"), [(0.0, 0.0), (0.46, 0.1), (0.8, 0.5)])
def test_restitution_and_ratio_of_a_known_impulse_are_found(restitution, ratio):
    left, spun = _after(_impulse(restitution, ratio))
    assert impact_law(CAME, left, SPIN, spun, ARM, INERTIA) == pytest.approx((restitution, ratio), abs=1e-12)


def test_a_change_of_spin_that_no_impulse_at_the_contact_makes_is_no_impact():
    left, spun = _after(_impulse(0.5, 0.1))
    assert np.isnan(impact_law(CAME, left, SPIN, 2.0 * SPIN - spun, ARM, INERTIA)).all()
    assert np.isnan(impact_law(-CAME, left, SPIN, spun, ARM, INERTIA)).all()
