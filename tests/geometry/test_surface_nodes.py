import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.polyhedron import box_vertices
from blockshake.geometry.surface_nodes import box_nodes, line_nodes

SIZE, CHAMFER = np.array([0.8, 2.4, 1.6]), 0.02
FLAT = 0.76  # m, the narrower width of a flat that ends at edges along y or z
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
    """A negative area would pull. 0.2 m spacing, 0.5 % inset; also at twice and half of each."""
    for spacing in (0.1, 0.2, 0.4):
        for inset in (0.0025, 0.005, 0.01):
            _, areas = box_nodes(SIZE, CHAMFER, 0.0, spacing, inset)
            assert (areas > 0.0).all()


@given(st.floats(0.05, 1.0), st.floats(0.0005, 0.03))
@settings(max_examples=30, deadline=None)
def test_areas_and_second_moments_of_every_flat_are_exact(spacing, inset):
    """Spacing and inset then change no stiffness, in compression or rocking (docs/decisions/0001)."""
    points, areas = box_nodes(SIZE, CHAMFER, 0.0, spacing, inset)
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
    points, _ = box_nodes(SIZE, CHAMFER, 0.0, 0.2, 0.005)
    for point in points:
        # a micrometre inside, where a contact would find it: the ridge's 45 degrees must not show
        axis = np.argmin(SIZE / 2.0 - np.abs(point))
        inside = point.copy()
        inside[axis] -= 1e-6 * np.sign(point[axis])
        phi, *normal = box_distance(*inside, *(SIZE / 2.0), CHAMFER)
        assert phi == pytest.approx(-1e-6, abs=1e-15)
        assert normal[axis] == np.sign(point[axis])


def _sunk(rotation, chamfer, nodes):
    """How deep a box is in a plane below when its first node touches [m]."""
    return rotation.apply(nodes)[:, 2].min() - rotation.apply(box_vertices(SIZE, chamfer))[:, 2].min()


@pytest.mark.parametrize("inset", [0.005, 0.001])
def test_how_deep_an_edge_sinks_into_a_plane_before_a_node_touches(inset):
    """At the tilt a the flat's ridge is inset sin(a) below its nodes."""
    flat = box_nodes(SIZE, CHAMFER, 0.0, 0.2, inset / FLAT)[0]
    for tilt in np.radians(np.arange(1.0, 45.5, 1.0)):
        rotation = Rotation.from_rotvec([0.0, tilt, 0.0])
        assert _sunk(rotation, CHAMFER, flat) == pytest.approx(inset * np.sin(tilt), abs=1e-12)


def test_how_deep_a_corner_sinks_into_a_plane_before_a_node_touches():
    """Straight down a cube's diagonal: 2 inset / sqrt(3) of a sharp one, (chamfer + 4 inset) / (2 sqrt(3)) chamfered.

    The flat's node is (chamfer + inset)(1, 1, 0) from the corner, where the body is chamfer/2 (1, 1, 1) from it.
    """
    inset = 0.005
    down, _ = Rotation.align_vectors([[0.0, 0.0, -1.0]], [[1.0, 1.0, 1.0]])
    sharp = box_nodes(SIZE, 0.0, 0.0, 0.2, inset / SIZE.min())[0]
    assert _sunk(down, 0.0, sharp) == pytest.approx(2.0 * inset / np.sqrt(3.0), abs=1e-12)
    flat = box_nodes(SIZE, CHAMFER, 0.0, 0.2, inset / FLAT)[0]
    assert _sunk(down, CHAMFER, flat) == pytest.approx(
        (CHAMFER + 4.0 * inset) / (2.0 * np.sqrt(3.0)), abs=1e-12
    )
