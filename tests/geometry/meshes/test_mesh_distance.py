import numpy as np
import pytest
import trimesh
from solid_angles import l_shape

from blockshake.geometry.meshes.mesh_distance import lattice_distances

ROUNDING = 1e-12


def _axes(low, high, count):
    # off the planes of the shapes, where the sign is a matter of rounding
    return [np.linspace(low, high, count) + shift for shift in (0.0123, 0.0077, 0.0031)]


def _points(axes):
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def _box_outside(points, low, high):
    """Distance to a sharp box, zero inside [m]."""
    return np.linalg.norm(np.maximum(np.maximum(low - points, points - high), 0.0), axis=-1)


def test_a_non_convex_shape():
    """Outside, the distance to a union is the smaller one; the sign is membership in either box."""
    axes = _axes(-0.5, 1.5, 41)
    points = _points(axes)
    values = lattice_distances(*l_shape(), axes)
    one = _box_outside(points, np.zeros(3), np.array([1.0, 0.5, 1.0]))
    other = _box_outside(points, np.zeros(3), np.array([0.5, 1.0, 1.0]))
    outside = np.minimum(one, other)
    np.testing.assert_array_equal(values < 0.0, outside == 0.0)
    np.testing.assert_allclose(values[outside > 0.0], outside[outside > 0.0], atol=ROUNDING)
    # inside, next to the re-entrant edge, the nearest point is on that edge
    x, y, z = np.array([0.45]), np.array([0.47]), np.array([0.5])
    inside = lattice_distances(*l_shape(), (x, y, z))
    assert inside[0, 0, 0] == pytest.approx(-np.hypot(0.05, 0.03), abs=ROUNDING)


def test_obtuse_thin_and_turned_triangles():
    """Against trimesh's point-to-triangle distance, over a hull of uneven triangles."""
    rng = np.random.default_rng(1)
    cloud = rng.normal(size=(40, 3)) * [1.0, 0.2, 0.02]
    mesh = trimesh.convex.convex_hull(cloud)
    axes = _axes(-1.5, 1.5, 9)
    points = _points(axes).reshape(-1, 3)
    corners = np.array(mesh.triangles)
    nearest = np.min(
        [
            np.linalg.norm(
                trimesh.triangles.closest_point(np.repeat(corners[[t]], len(points), axis=0), points)
                - points,
                axis=1,
            )
            for t in range(len(corners))
        ],
        axis=0,
    )
    values = lattice_distances(mesh.vertices, mesh.faces, axes).ravel()
    np.testing.assert_allclose(np.abs(values), nearest, atol=ROUNDING)
    planes = mesh.face_normals @ points.T - (mesh.face_normals * corners[:, 0]).sum(axis=1)[:, None]
    np.testing.assert_array_equal(values < 0.0, planes.max(axis=0) < 0.0)


def test_a_sharp_tip_has_the_right_sign_all_around():
    """Where only the angle-weighted normal of the corner tells (Baerentzen and Aanaes 2005): a thin needle's tip."""
    base = [[0.0, 0.1, 0.0], [0.0, -0.05, 0.08], [0.0, -0.05, -0.08]]
    vertices = np.array([*base, [3.0, 0.0, 0.0]])
    faces = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
    if trimesh.Trimesh(vertices, faces, process=False).volume < 0.0:
        faces = faces[:, ::-1]
    rng = np.random.default_rng(2)
    for direction in rng.normal(size=(500, 3)):
        point = (
            vertices[3] + 0.3 * direction / np.linalg.norm(direction) * [0.02, 1.0, 1.0] + [0.001, 0.0, 0.0]
        )
        value = lattice_distances(vertices, faces, [np.array([part]) for part in point])
        assert value[0, 0, 0] > 0.0


def test_a_flat_triangle_on_an_edge_changes_nothing():
    """Meshes from scans and CAD have them: one edge is split at its middle on one side only."""
    vertices, faces = l_shape()
    a, b, c = faces[0]
    other = next(t for t in range(1, len(faces)) if {a, b} <= set(faces[t]))
    middle = len(vertices)
    split = np.vstack([vertices, 0.5 * (vertices[a] + vertices[b])])
    # the face (a, b, c) is cut at the middle of ab; the gap to its uncut neighbour is closed by a sliver
    sliced = np.vstack([np.delete(faces, 0, axis=0), [[a, middle, c], [middle, b, c], [a, b, middle]]])
    assert other > 0
    axes = _axes(-0.3, 1.3, 17)
    np.testing.assert_allclose(
        lattice_distances(split, sliced, axes), lattice_distances(vertices, faces, axes), atol=ROUNDING
    )
