import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, mass_properties, triangles

BLOCK, CHAMFER = np.array([0.8, 2.4, 1.6]), 0.02
ROUNDING = 1e-12  # relative, of sums of some hundred terms

sizes = st.tuples(*[st.floats(0.2, 3.0)] * 3)


def _chamfered_box_by_slices(size, chamfer):
    """Volume and diagonal second moments from rectangles with cut corners, stacked along z.

    At height z the section is a rectangle whose half sides are reduced by ``t``, the height above
    the upper flat's chamfer line, less four corner triangles. The vertical edges' cut stays where
    it is, so that its leg in the reduced rectangle is ``chamfer - 2 t`` until it vanishes at
    half the chamfer. Every part is polynomial in ``t``: Gauss-Legendre with 6 points is exact.
    """
    points, weights = np.polynomial.legendre.leggauss(6)
    half = np.asarray(size) / 2.0
    total = np.zeros(4)  # of 1, x2, y2, z2

    def section(t):
        a, b, leg = half[0] - t, half[1] - t, max(chamfer - 2.0 * t, 0.0)
        area = 4.0 * a * b - 2.0 * leg**2
        moments = []
        for u, v in ((a, b), (b, a)):
            # a corner triangle with its right angle at u: centroid u - leg/3, own moment leg^4/36
            triangle = leg**4 / 36.0 + leg**2 / 2.0 * (u - leg / 3.0) ** 2
            moments.append(4.0 * u**3 * v / 3.0 - 4.0 * triangle)
        return np.array([area, *moments])

    def add(low, high, t_of_z):
        for point, weight in zip(points, weights, strict=True):
            z = 0.5 * (low + high) + 0.5 * (high - low) * point
            part = section(t_of_z(z)) * weight * 0.5 * (high - low)
            total[:3] += 2.0 * part
            total[3] += 2.0 * part[0] * z**2

    edge = half[2] - chamfer
    add(0.0, edge, lambda z: 0.0)
    add(edge, edge + chamfer / 2.0, lambda z: z - edge)
    add(edge + chamfer / 2.0, half[2], lambda z: z - edge)
    x2, y2, z2 = total[1:]
    return total[0], np.array([y2 + z2, x2 + z2, x2 + y2])


@given(sizes, st.floats(0.001, 0.45))
@settings(max_examples=25, deadline=None)
def test_mass_properties_of_the_chamfered_box_are_the_slicing_integral(size, part):
    chamfer = part * min(size)
    solid = convex_polyhedron(box_vertices(size, chamfer))
    properties = mass_properties(solid.vertices, triangles(solid))
    volume, inertia = _chamfered_box_by_slices(size, chamfer)
    assert properties.volume == pytest.approx(volume, rel=1e-10)
    np.testing.assert_allclose(np.diag(properties.inertia), inertia, rtol=1e-10)
    np.testing.assert_array_equal(properties.inertia, np.diag(np.diag(properties.inertia)))
    np.testing.assert_allclose(properties.centroid, 0.0, atol=1e-13)


def test_a_sharp_box_has_the_textbook_inertia():
    solid = convex_polyhedron(box_vertices(BLOCK, 0.0))
    properties = mass_properties(solid.vertices, triangles(solid))
    a, b, c = BLOCK**2
    assert properties.volume == pytest.approx(BLOCK.prod(), rel=ROUNDING)
    expected = BLOCK.prod() / 12.0 * np.array([b + c, a + c, a + b])
    np.testing.assert_allclose(np.diag(properties.inertia), expected, rtol=ROUNDING)


@pytest.mark.parametrize(("chamfer", "vertices", "faces"), [(0.0, 8, 6), (CHAMFER, 32, 18)])
def test_faces_edges_and_corners_of_the_box(chamfer, vertices, faces):
    """Six flats and twelve chamfers; Euler: corners - edges + faces = 2."""
    solid = convex_polyhedron(box_vertices(BLOCK, chamfer))
    edges = sum(len(face) for face in solid.faces) // 2
    assert (len(solid.vertices), len(solid.faces)) == (vertices, faces)
    assert vertices - edges + faces == 2
    for face, normal, offset in zip(solid.faces, solid.normals, solid.offsets, strict=True):
        np.testing.assert_allclose(solid.vertices[face] @ normal, offset, atol=1e-14)
        assert (solid.vertices @ normal).max() <= offset + 1e-14
        # counter-clockwise seen from outside: the polygon's area vector looks along the normal
        around = solid.vertices[face]
        assert np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0) @ normal > 0.0


def test_the_outward_normals_close():
    """Divergence theorem: the area vectors of a closed surface sum to zero."""
    solid = convex_polyhedron(box_vertices(BLOCK, CHAMFER))
    corners = solid.vertices[triangles(solid)]
    area = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.testing.assert_allclose(area.sum(axis=0), 0.0, atol=1e-13)
    flats = BLOCK - 2.0 * CHAMFER
    area_of_flats = 2.0 * (flats[0] * flats[1] + flats[0] * flats[2] + flats[1] * flats[2])
    # a chamfer is a hexagon: a strip of its edge's flat length and two triangles half a chamfer high
    area_of_chamfers = 4.0 * np.sqrt(2.0) * CHAMFER * (flats.sum() + 3.0 * CHAMFER / 2.0)
    assert np.linalg.norm(area, axis=1).sum() == pytest.approx(area_of_flats + area_of_chamfers, rel=1e-10)


def test_points_inside_the_hull_are_dropped():
    corners = box_vertices([1.0, 1.0, 1.0], 0.0)
    solid = convex_polyhedron(np.vstack([[[0.0, 0.0, 0.0], [0.5, 0.1, 0.2]], corners]))
    assert len(solid.vertices) == 8
    assert all(len(face) == 4 for face in solid.faces)


@pytest.mark.parametrize("seed", range(5))
def test_every_edge_lies_between_two_faces(seed):
    """A grid of corners that bulges by rounding of single precision: facets in nearly the same plane (Euler 1758)."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(*[np.linspace(-0.3, 0.3, 12)] * 2), axis=-1).reshape(-1, 2)
    bulge = -1e-6 * (grid**2).sum(axis=1) + 3e-8 * rng.normal(size=len(grid))
    polyhedron = convex_polyhedron(np.vstack([np.column_stack([grid, bulge]), [[0.1, 0.0, -0.5]]]))
    edges = [tuple(edge) for face in polyhedron.faces for edge in zip(face, np.roll(face, -1), strict=True)]
    assert len(set(edges)) == len(edges)
    assert {edge[::-1] for edge in edges} == set(edges)
    assert len(polyhedron.vertices) - len(edges) / 2 + len(polyhedron.faces) == 2
