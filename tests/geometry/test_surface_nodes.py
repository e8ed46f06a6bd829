import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.surface_nodes import box_nodes, line_nodes

SIZE, CHAMFER = np.array([0.8, 2.4, 1.6]), 0.02
ROUNDING = 1e-12  # relative


@given(st.floats(0.1, 5.0), st.floats(0.01, 2.0), st.floats(0.0, 0.2))
@settings(max_examples=100, deadline=None)
def test_weights_on_a_line_integrate_cubic_functions(length, spacing, relative_inset):
    inset = relative_inset * min(length, spacing)
    positions, weights = line_nodes(length, spacing, inset)
    assert weights.sum() == pytest.approx(length, rel=ROUNDING)
    assert weights @ positions == pytest.approx(0.0, abs=ROUNDING * length**2)
    assert weights @ positions**2 == pytest.approx(length**3 / 12.0, rel=1e-10)
    assert weights @ positions**3 == pytest.approx(0.0, abs=ROUNDING * length**4)
    assert abs(positions).max() == pytest.approx(length / 2.0 - inset, rel=ROUNDING)
    assert np.allclose(np.diff(positions), np.diff(positions)[0])


def test_two_intervals_without_inset_are_simpsons_rule():
    _, weights = line_nodes(6.0, 3.0, 0.0)
    np.testing.assert_allclose(weights, [1.0, 4.0, 1.0], rtol=ROUNDING)


def test_the_papers_layout_has_positive_areas():
    """A negative area would pull. 0.2 m spacing, 5 mm inset; also at twice and half of each."""
    for spacing in (0.1, 0.2, 0.4):
        for inset in (0.0025, 0.005, 0.01):
            _, areas = box_nodes(SIZE, CHAMFER, spacing, inset)
            assert (areas > 0.0).all()


@given(st.floats(0.05, 1.0), st.floats(0.0005, 0.03))
@settings(max_examples=30, deadline=None)
def test_areas_and_second_moments_of_every_flat_are_exact(spacing, inset):
    """So that spacing and inset change no stiffness, in compression or rocking (facts.md 3.5)."""
    assume(spacing > 2.0 * inset)
    points, areas = box_nodes(SIZE, CHAMFER, spacing, inset)
    for axis in range(3):
        first, second = [other for other in range(3) if other != axis]
        width, depth = SIZE[first] - 2.0 * CHAMFER, SIZE[second] - 2.0 * CHAMFER
        for side in (-0.5, 0.5):
            flat = (np.abs(points[:, axis] - side * SIZE[axis]) == 0.0) & (
                np.abs(points[:, first]) < SIZE[first] / 2
            )
            flat &= np.abs(points[:, second]) < SIZE[second] / 2
            p, a = points[flat], areas[flat]
            assert a.sum() == pytest.approx(width * depth, rel=ROUNDING)
            assert a @ p[:, first] ** 2 == pytest.approx(width**3 * depth / 12.0, rel=1e-10)
            assert a @ p[:, second] ** 2 == pytest.approx(depth**3 * width / 12.0, rel=1e-10)
            assert a @ (p[:, first] * p[:, second]) == pytest.approx(0.0, abs=ROUNDING)


def test_every_node_lies_on_the_surface_where_the_normal_is_the_flats():
    points, _ = box_nodes(SIZE, CHAMFER, 0.2, 0.005)
    for point in points:
        # a micrometre inside, where a contact would find it: the ridge's 45 degrees must not show
        axis = np.argmin(SIZE / 2.0 - np.abs(point))
        inside = point.copy()
        inside[axis] -= 1e-6 * np.sign(point[axis])
        phi, *normal = box_distance(*inside, *(SIZE / 2.0), CHAMFER)
        assert phi == pytest.approx(-1e-6, abs=1e-15)
        assert normal[axis] == np.sign(point[axis])
