"""Covariance of the required wrenches: roots by which the noise of one instant goes with that of another."""

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.forces.required import covariance_root


def test_roots_of_information_that_hardly_changes_hardly_change():
    """Roots of different instants are multiplied with each other: eigenvectors have free signs and cross."""
    turns = Rotation.from_rotvec(np.linspace([0.0, 0.0, 0.0], [0.5, 1.0, -2.0], 400)).as_matrix()
    information = np.zeros((400, 6, 6))
    # the first two eigenvalues change places on the way
    sizes = np.stack([np.linspace(1.0, 3.0, 400), np.full(400, 2.0), np.full(400, 8.0)], axis=1)
    information[:, :3, :3] = np.einsum("tij,tj,tkj->tik", turns, sizes, turns)
    information[:, 3:, 3:] = np.einsum("tji,tj,tjk->tik", turns, sizes[::-1], turns)
    roots = covariance_root(information)
    inverse = np.linalg.inv(information)
    np.testing.assert_allclose(roots @ np.swapaxes(roots, 1, 2), inverse, atol=1e-12)
    assert np.abs(np.diff(roots, axis=0)).max() < 0.02


def test_a_direction_that_is_not_read_has_no_root():
    information = np.zeros((1, 6, 6))
    information[0, :5, :5] = np.diag([1.0, 2.0, 3.0, 4.0, 5.0])
    np.testing.assert_allclose(
        covariance_root(information)[0], np.diag([1, 2**-0.5, 3**-0.5, 0.5, 5**-0.5, 0])
    )
