"""Frequencies of free boxes: against Rayleigh and Ritz, Lame's exact mode, and the theory of beams."""

import numpy as np
import pytest
from ritz import ritz_frequencies

from blockshake.solvers.nscd_deformable.shapes import elastic_shapes

ALL = 10**9
BLOCK = (0.8, 2.4, 1.6)


def _mesh_frequencies(size, nu, mesh_size, count):
    return np.sqrt(elastic_shapes(size, nu, mesh_size, 10.0, 2 * count).squared_frequency[:count])


def test_rayleigh_and_ritz_have_converged():
    """Raising the degree from 8 to 10 lowers the block's ten lowest frequencies by less than 0.3 %."""
    coarse, fine = (ritz_frequencies(BLOCK, 0.2, order, 10) for order in (8, 10))
    assert (coarse >= fine * (1.0 - 1e-9)).all()
    assert coarse == pytest.approx(fine, rel=3e-3)


def test_the_papers_mesh_has_the_blocks_frequencies():
    """Ten lowest of the 0.8 x 2.4 x 1.6 m block at 0.2 m: 3 % above Rayleigh and Ritz at most, the first 1.6 %."""
    excess = _mesh_frequencies(BLOCK, 0.2, 0.2, 10) / ritz_frequencies(BLOCK, 0.2, 10, 10) - 1.0
    assert excess.min() > 0.0
    assert excess.max() < 0.03
    assert excess[0] < 0.016


@pytest.mark.parametrize("size", [(1.0, 1.0, 1.0), (1.0, 1.0, 2.0), (0.5, 1.0, 1.5)])
def test_frequencies_converge_with_the_square_of_the_mesh(size):
    """Cube and prisms: halving the bricks divides the error of each of six frequencies by about four."""
    truth = ritz_frequencies(size, 0.3, 10, 6)
    errors = [np.abs(_mesh_frequencies(size, 0.3, mesh, 6) / truth - 1.0) for mesh in (0.25, 0.125)]
    assert errors[1].max() < 0.025
    assert (errors[0].sum() / errors[1].sum()) == pytest.approx(4.0, rel=0.1)


def test_a_cube_has_lames_mode():
    """Lame (1852): an equivoluminal mode of a free cube at ``omega = sqrt(2) pi c_s / a``, exactly."""
    lame = np.sqrt(2.0) * np.pi * np.sqrt(0.5 / 1.3)
    nearest = [
        np.abs(_mesh_frequencies((1.0, 1.0, 1.0), 0.3, mesh, 15) / lame - 1.0).min() for mesh in (0.25, 0.125)
    ]
    assert nearest[1] < 0.01
    assert nearest[0] / nearest[1] == pytest.approx(4.0, rel=0.2)
    assert np.abs(ritz_frequencies((1.0, 1.0, 1.0), 0.3, 10, 15) / lame - 1.0).min() < 1e-5


def test_a_beam_one_brick_deep_bends_as_it_should():
    """The steel beam at 0.2 m: Euler and Bernoulli's 22.37 less Timoshenko's shear and rotary inertia, within 3 %.

    Bricks without incompatible modes would be far stiffer.
    """
    length, depth, nu = 2.4, 0.2, 0.3
    radius = depth / np.sqrt(12.0)
    beam = 22.373 / length**2 * radius
    # Timoshenko's correction of the first mode to first order, shear factor 10 (1 + nu) / (12 + 11 nu), Cowper (1966)
    factor = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
    slender = (radius / length) ** 2
    corrected = beam / np.sqrt(1.0 + slender * (49.48 + 12.3 * 2.0 * (1.0 + nu) / factor))
    found = _mesh_frequencies((length, depth, depth), nu, 0.2, 2)
    assert found[0] == pytest.approx(found[1], rel=1e-6)
    assert found[0] == pytest.approx(corrected, rel=0.03)
    assert found[0] == pytest.approx(ritz_frequencies((length, depth, depth), nu, 12, 1)[0], rel=0.03)


def test_youngs_modulus_and_density_only_rescale():
    """Shapes are of unit mass and orthogonal, so one set serves all samples; rigid motions are not among them."""
    shapes = elastic_shapes(BLOCK, 0.2, 0.4, 0.8, 6)
    assert shapes.squared_frequency.min() > 0.1
    assert np.diff(shapes.squared_frequency).min() >= 0.0


def test_all_modes_are_as_many_as_the_mesh_has():
    shapes = elastic_shapes((1.0, 1.0, 1.0), 0.2, 0.5, 0.5, ALL)
    assert shapes.displacement.shape == (81, 75)
