import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull, cKDTree
from solid_angles import l_shape

from blockshake.geometry.meshes.mesh_distance import lattice_distances
from blockshake.geometry.meshes.mesh_nodes import mesh_nodes
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, triangles

SIZE, CHAMFER = np.array([0.8, 2.4, 1.6]), 0.02
INSET = 0.01  # over the breadth of a face, twice its area over its perimeter


def _box(chamfer=CHAMFER):
    solid = convex_polyhedron(box_vertices(SIZE, chamfer))
    return solid.vertices, triangles(solid)


def _depth(points, mesh):
    return np.array(
        [lattice_distances(*mesh, [np.array([part]) for part in point])[0, 0, 0] for point in points]
    )


@pytest.mark.parametrize("spacing", [0.1, 0.2, 0.4])
def test_over_every_flat_of_a_box_area_and_second_moments_are_exact(spacing):
    """An interface's stiffness in compression and in rocking follows from both (docs/decisions/0001)."""
    points, areas = mesh_nodes(*_box(), spacing, INSET)
    assert (areas > 0.0).all()
    for axis in range(3):
        first, second = [other for other in range(3) if other != axis]
        width, depth = SIZE[first] - 2.0 * CHAMFER, SIZE[second] - 2.0 * CHAMFER
        for side in (-0.5, 0.5):
            on = np.isclose(points[:, axis], side * SIZE[axis], atol=1e-9)
            p, a = points[on], areas[on]
            assert a.sum() == pytest.approx(width * depth, rel=1e-9)
            assert a @ p[:, first] == pytest.approx(0.0, abs=1e-9)
            assert a @ p[:, first] ** 2 == pytest.approx(width**3 * depth / 12.0, rel=1e-8)
            assert a @ p[:, second] ** 2 == pytest.approx(depth**3 * width / 12.0, rel=1e-8)
            assert a @ (p[:, first] * p[:, second]) == pytest.approx(0.0, abs=1e-9)
            # the pivots of rocking, and the corners
            inset = INSET * width * depth / (width + depth)
            assert np.abs(p[:, first]).max() == pytest.approx(width / 2.0 - inset, abs=1e-9)
            assert np.abs(p[:, second]).max() == pytest.approx(depth / 2.0 - inset, abs=1e-9)
            corners = (np.abs(p[:, first]) > width / 2.0 - 1.01 * inset) & (
                np.abs(p[:, second]) > depth / 2.0 - 1.01 * inset
            )
            assert corners.sum() == 4
            count = width * depth / spacing**2
            assert count < on.sum() < 3.0 * count + 24  # perimeter nodes come on top of one a spacing squared


def test_nodes_of_a_sphere_are_even_and_lie_on_it():
    mesh = trimesh.creation.icosphere(4, 0.5)
    points, areas = mesh_nodes(mesh.vertices, mesh.faces, 0.1, INSET)
    spacing = np.sqrt(mesh.area / 6.0) / 20.0
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-9)
    assert len(points) == pytest.approx(mesh.area / spacing**2, rel=0.25)
    apart = cKDTree(points).query(points, k=2)[0][:, 1]
    assert apart.min() > 0.6 * spacing
    assert apart.max() < 1.4 * spacing
    assert areas.std() / areas.mean() < 0.2
    # second moments of a thin shell, 2/3 m r^2 by its integral: a third of the area times r^2 each way
    moments = (areas[:, None, None] * points[:, :, None] * points[:, None, :]).sum(axis=0)
    np.testing.assert_allclose(moments, np.eye(3) * mesh.area * 0.25 / 3.0, atol=0.003 * mesh.area * 0.25)
    assert (
        np.abs(_depth(points, (mesh.vertices, mesh.faces))).max() < 0.03**2 / 0.5
    )  # facets' edges are 0.03 m


def test_a_face_finer_meshed_gets_the_same_nodes_roughly():
    """Spacing, not the mesh, states how many: a cube cut into 12 and into 12288 triangles."""
    coarse = trimesh.creation.box([1.0, 1.0, 1.0])
    fine = coarse.subdivide().subdivide().subdivide().subdivide().subdivide()
    few, many = (
        mesh_nodes(coarse.vertices, coarse.faces, 0.2, INSET),
        mesh_nodes(fine.vertices, fine.faces, 0.2, INSET),
    )
    assert len(many[0]) == pytest.approx(len(few[0]), rel=0.1)
    assert many[1].sum() == pytest.approx(6.0, rel=1e-9)


def test_sharp_convex_edges_have_nodes_on_both_sides_and_reentrant_ones_none():
    vertices, faces = l_shape()
    points, areas = mesh_nodes(vertices, faces, 0.2, INSET)
    assert areas.sum() == pytest.approx(2 * 0.75 + 4.0, rel=1e-9)
    np.testing.assert_allclose(_depth(points, (vertices, faces)), 0.0, atol=1e-12)

    def beside(x, y):
        return (np.hypot(points[:, 0] - x, points[:, 1] - y) < 1.01 * INSET) & (
            np.abs(points[:, 2] - 0.5) < 0.45
        )

    for x, y in vertices[:6, :2]:
        reentrant = (x, y) == (0.5, 0.5)
        assert beside(x, y).any() != reentrant
    # a corner's three faces each have a node at the inset from both edges; breadths 0.75 / 2, 1 / 2 and 1 / 3 m
    near = np.linalg.norm(points - vertices[1], axis=1) < 1.5 * INSET
    breadths = np.array([[0.375], [0.5], [1.0 / 3.0]])
    expected = vertices[1] + INSET * breadths * np.array([[-1, 1, 0], [-1, 0, 1], [0, 1, 1]])
    np.testing.assert_allclose(np.sort(points[near], axis=0), np.sort(expected, axis=0), atol=1e-12)


def test_a_rounded_edge_is_no_edge():
    """A cylinder's mantle is one face, its caps two: nodes at the inset along both rims, on both sides."""
    mesh = trimesh.creation.cylinder(0.5, 1.0, sections=64)
    points, areas = mesh_nodes(mesh.vertices, mesh.faces, 0.2, INSET)
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-9)
    radius, height = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    rim = np.isclose(height, 0.5, atol=1e-9) & (radius > 0.49)
    assert rim.sum() == round(2.0 * np.pi * 0.5 / 0.2)  # the caps are flat
    # breadths: the radius of a cap, the height of the mantle; chords of 5.6 degrees
    np.testing.assert_allclose(radius[rim], 0.5 - INSET * 0.5, atol=0.002)
    below = np.isclose(height, 0.5 - INSET * 1.0, atol=1e-9)
    assert below.sum() == round(2.0 * np.pi * 0.5 / (np.sqrt(mesh.area / 6.0) / 20.0))


@pytest.mark.parametrize("spacing", [0.2, 1.0])
def test_a_rounded_body_stands_on_its_nodes_as_its_mesh_stands(spacing):
    """A pebble with a foot, whose rim is no edge: the facet of the nodes' hull under its middle is level, too."""
    vertices = trimesh.creation.icosphere(4, 0.3).vertices
    pebble = trimesh.convex.convex_hull(
        np.column_stack([vertices[:, :2], np.maximum(vertices[:, 2], -0.285)])
    )
    points, _ = mesh_nodes(pebble.vertices, pebble.faces, spacing, INSET)
    normal, offset = np.split(ConvexHull(points).equations, [3], axis=1)
    below = normal[:, 2] < -1e-9
    foot = normal[below][np.argmin(offset[below, 0] / normal[below, 2])]
    assert np.degrees(np.arccos(min(-foot[2], 1.0))) < 0.1


def test_the_same_mesh_gives_the_same_bytes():
    first, second = mesh_nodes(*_box(), 0.2, INSET), mesh_nodes(*_box(), 0.2, INSET)
    np.testing.assert_array_equal(first[0], second[0])
    np.testing.assert_array_equal(first[1], second[1])
