"""Rotation of a free body: momentum and energy are kept, and an axis of symmetry precesses."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from blockshake.dynamics.free_turning import free_turning
from blockshake.geometry.rotations import rotation_matrices

INERTIA = np.diag([1.0, 1.3, 0.8])  # kg m2
LEVEL = np.array([[1.0, 0.0, 0.0, 0.0]])


def test_two_bodies_turn_as_each_alone_and_keep_their_energy():
    time = np.linspace(0.0, 2.0, 2001)
    momenta = np.array([[1.0, 2.0, -0.5], [0.2, 0.1, 3.0]])
    starts = np.array([[1.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.8, 0.0]])
    inverse = np.linalg.inv(INERTIA)
    both = free_turning(starts, momenta, inverse, time)
    for path, start, momentum in zip(both, starts, momenta, strict=True):
        assert_allclose(free_turning(start[None], momentum[None], inverse, time)[0], path, rtol=0.0, atol=0.0)
        body = np.einsum("nji,j->ni", rotation_matrices(path), momentum)
        energy = 0.5 * np.einsum("ni,ij,nj->n", body, inverse, body)
        assert_allclose(energy, energy[0], rtol=1e-6)


@pytest.mark.parametrize("step", [1e-2, 5e-3])
def test_an_axis_of_symmetry_precesses_about_the_momentum(step):
    """At ``L / I`` of the transverse inertia (Goldstein 1980, section 5-7); the midpoint rule is of second order."""
    inertia = np.array([1.0, 1.0, 0.4])
    momentum = np.array([0.0, 3.0, 4.0])
    time = step * np.arange(round(1.0 / step) + 1)
    path = free_turning(LEVEL, momentum[None], np.diag(1.0 / inertia), time)[0]
    axis = rotation_matrices(path)[-1] @ [0.0, 0.0, 1.0]
    along = momentum / np.linalg.norm(momentum)
    turn = np.linalg.norm(momentum) / inertia[0] * time[-1]
    first = np.array([0.0, 0.0, 1.0])
    level = first - along * (along @ first)
    expected = along * (along @ first) + np.cos(turn) * level + np.sin(turn) * np.cross(along, first)
    assert_allclose(axis, expected, atol=20.0 * step**2)
