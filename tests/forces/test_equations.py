"""Accelerations of bodies from readings along lines."""

import numpy as np
import pytest

from blockshake.forces.equations import AccelerationEquations

X, Z = np.eye(3)[0], np.eye(3)[2]


def test_a_pitch_that_is_read_roughly_is_read_where_the_other_rotations_are_held():
    """Two markers on a vertical line tell a planar motion; the rest is held, however sharply beside rough readings."""
    equations = AccelerationEquations(1, 1)
    pitch, variance, half = (
        0.5,
        12.0,
        0.4,
    )  # rad/s2, m2/s4, m: as of markers of 0.1 mm under a kernel of 15 ms
    for end in (-half, half):
        values = np.array([[pitch * end, 0.0]])
        equations.add(0, np.array([[X, Z]]), np.array([[0.0, 0.0, end]]), values, np.full((1, 2), variance))
    equations.hold([0], [1, 3, 5])
    acceleration, information = equations.solve()
    assert acceleration[0, 0] == pytest.approx([0.0, 0.0, 0.0, 0.0, pitch, 0.0], abs=1e-4)
    assert information[0, 0, 4, 4] == pytest.approx(2.0 * half**2 / variance, rel=1e-3)
