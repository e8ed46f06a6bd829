"""Accelerations of bodies from readings along lines."""

import numpy as np
import pytest

from blockshake.forces.equations import AccelerationEquations
from blockshake.forces.kernel_noise import Colour

WHITE = Colour(True, 0.0)
X, Z = np.eye(3)[0], np.eye(3)[2]


def test_a_pitch_that_is_read_roughly_is_read_where_the_other_rotations_are_held():
    """Two markers on a vertical line tell a planar motion; the rest is held, however sharply with rough readings."""
    equations = AccelerationEquations(1, 1)
    pitch, variance, half = (
        0.5,
        12.0,
        0.4,
    )  # rad/s2, m2/s4, m: as of markers of 0.1 mm under a kernel of 15 ms
    for end in (-half, half):
        values = np.array([[pitch * end, 0.0]])
        equations.add(
            0,
            np.array([[X, Z]]),
            np.array([[0.0, 0.0, end]]),
            values,
            {WHITE: np.full((1, 2), variance**0.5)},
        )
    equations.hold([0], [1, 3, 5])
    acceleration, information = equations.solve()
    assert acceleration[0, 0] == pytest.approx([0.0, 0.0, 0.0, 0.0, pitch, 0.0], abs=1e-4)
    assert information[0, 0, 4, 4] == pytest.approx(2.0 * half**2 / variance, rel=1e-3)


def test_errors_are_a_root_of_the_covariance_and_keep_the_parts_of_the_noise_apart():
    equations, rows = AccelerationEquations(1, 1), np.eye(3)[None]
    noise = {WHITE: np.full((1, 3), 0.3), Colour(False, 0.1): np.full((1, 3), 0.4)}
    for arm in ([0.0, 0.0, 1.0], [0.0, 1.0, -1.0], [1.0, -1.0, 0.0]):
        equations.add(0, rows, np.array([arm]), np.zeros((1, 3)), noise)
    (errors,), information = equations.errors(), equations.solve()[1][0, 0]
    covariances = {colour: part[0] @ part[0].T for colour, part in errors.items()}
    np.testing.assert_allclose(sum(covariances.values()), np.linalg.inv(information), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(covariances[WHITE] / 0.09, covariances[Colour(False, 0.1)] / 0.16, atol=1e-9)
