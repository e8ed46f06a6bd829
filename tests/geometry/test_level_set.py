import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron

SIZE = np.array([0.8, 2.4, 1.6])
ROUNDING = 1e-14  # m, of sums of metres


def _evaluate(points, size, chamfer):
    values = np.array([box_distance(*point, *(np.asarray(size) / 2.0), chamfer) for point in points])
    return values[:, 0], values[:, 1:]


def _true_distance_outside(point, solid):
    """Distance of a point to a convex polyhedron: the nearest of faces, edges and corners."""
    best = np.linalg.norm(solid.vertices - point, axis=1).min()
    for face, normal, offset in zip(solid.faces, solid.normals, solid.offsets, strict=True):
        corners = solid.vertices[face]
        along = np.roll(corners, -1, axis=0) - corners
        part = np.clip(((point - corners) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        best = min(best, np.linalg.norm(corners + part[:, None] * along - point, axis=1).min())
        foot = point - (normal @ point - offset) * normal
        inside = (np.cross(along, foot - corners) @ normal >= 0.0).all()
        if inside and normal @ point >= offset:
            best = min(best, normal @ point - offset)
    return best


@pytest.mark.parametrize("chamfer", [0.0, 0.02, 0.3])
def test_inside_it_is_the_distance_to_the_nearest_plane(chamfer):
    """Zhou et al. (2023), Eq. (1): in a convex body the nearest surface point is on the nearest plane."""
    solid = convex_polyhedron(box_vertices(SIZE, chamfer))
    points = (np.random.default_rng(2).random((4000, 3)) - 0.5) * SIZE
    depth = points @ solid.normals.T - solid.offsets
    inside = depth.max(axis=1) < 0.0
    assert inside.sum() > 1000
    phi, normal = _evaluate(points[inside], SIZE, chamfer)
    np.testing.assert_allclose(phi, depth[inside].max(axis=1), atol=ROUNDING)
    nearest = solid.normals[depth[inside].argmax(axis=1)]
    np.testing.assert_allclose(normal, nearest, atol=1e-12)


@pytest.mark.parametrize("chamfer", [0.0, 0.02, 0.3])
def test_outside_it_is_a_positive_lower_bound(chamfer):
    solid = convex_polyhedron(box_vertices(SIZE, chamfer))
    points = (np.random.default_rng(3).random((400, 3)) - 0.5) * (SIZE + 0.6)
    outside = (points @ solid.normals.T - solid.offsets).max(axis=1) > 0.0
    phi, _ = _evaluate(points[outside], SIZE, chamfer)
    true = np.array([_true_distance_outside(point, solid) for point in points[outside]])
    assert (phi > 0.0).all()
    assert (phi <= true + ROUNDING).all()
    # not a useless bound: in front of a face it is the distance
    assert np.isclose(phi, true).mean() > 0.3


@given(st.tuples(*[st.floats(-2.0, 2.0)] * 3), st.floats(0.0, 0.39))
@settings(max_examples=200, deadline=None)
def test_the_normal_is_a_unit_vector_and_mirrors(point, chamfer):
    phi, normal = _evaluate([point], SIZE, chamfer)
    assert np.linalg.norm(normal[0]) == pytest.approx(1.0, abs=1e-15)
    for axis in range(3):
        if point[axis] == 0.0:
            continue
        mirrored = np.array(point)
        mirrored[axis] *= -1.0
        phi_mirrored, normal_mirrored = _evaluate([mirrored], SIZE, chamfer)
        normal_mirrored[0, axis] *= -1.0
        assert phi_mirrored[0] == phi[0]
        np.testing.assert_array_equal(normal_mirrored[0], normal[0])


@given(st.tuples(*[st.floats(-2.0, 2.0)] * 3), st.tuples(*[st.floats(-0.1, 0.1)] * 3))
@settings(max_examples=200, deadline=None)
def test_it_changes_by_at_most_the_distance_moved(point, step):
    """The skin of the node lists relies on this."""
    phi, _ = _evaluate([point, np.add(point, step)], SIZE, 0.02)
    assert abs(phi[1] - phi[0]) <= np.linalg.norm(step) + 1e-15
