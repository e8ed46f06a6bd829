import tracemalloc

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from blockshake.geometry.overlap import near_pairs, penetration_depths
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, mass_properties, triangles
from blockshake.geometry.structure import Solid

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
ROUNDING = 1e-12  # m


def _solid(size, chamfer=0.0):
    polyhedron = convex_polyhedron(box_vertices(size, chamfer))
    faces = triangles(polyhedron)
    return Solid(polyhedron.vertices, faces, polyhedron, mass_properties(polyhedron.vertices, faces))


CUBE = _solid([1.0, 1.0, 1.0])


def _turned(axis, degrees):
    return Rotation.from_rotvec(np.radians(degrees) * np.asarray(axis, float)).as_quat(scalar_first=True)


def penetration_depth(solid_a, position_a, orientation_a, solid_b, position_b, orientation_b):
    """Depth of a single pair [m]."""
    first, second = (position_a[None], orientation_a[None]), (position_b[None], orientation_b[None])
    return penetration_depths(solid_a, *first, solid_b, *second)[0]


@pytest.mark.parametrize("gap", [-0.2, -1e-3, 0.0, 1e-4, 0.3])
def test_faces_parallel(gap):
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, np.array([0.1, 0.2, 1.0 + gap]), UPRIGHT)
    assert depth == pytest.approx(-gap, abs=ROUNDING)


@pytest.mark.parametrize("gap", [-0.01, 0.02])
def test_an_edge_above_a_face(gap):
    """A cube turned by 45 degrees about y reaches sqrt(1/2) below its centre."""
    position = np.array([0.05, 0.0, 0.5 + np.sqrt(0.5) + gap])
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, position, _turned([0, 1, 0], 45.0))
    assert depth == pytest.approx(-gap, abs=ROUNDING)


@pytest.mark.parametrize("gap", [-0.01, 0.02])
def test_two_crossed_edges(gap):
    """Upper edge along x of one, lower edge along y of the other: only the cross product separates."""
    position = np.array([0.0, 0.0, 2.0 * np.sqrt(0.5) + gap])
    depth = penetration_depth(
        CUBE, np.zeros(3), _turned([1, 0, 0], 45.0), CUBE, position, _turned([0, 1, 0], 45.0)
    )
    assert depth == pytest.approx(-gap, abs=ROUNDING)


def _depth_by_every_axis(solid_a, rotation_a, solid_b, rotation_b, offset):
    """The theorem taken literally: all normals, and the products of all edges' directions."""
    points_a, points_b = rotation_a.apply(solid_a.vertices), rotation_b.apply(solid_b.vertices) + offset
    axes = [rotation_a.apply(solid_a.polyhedron.normals), rotation_b.apply(solid_b.polyhedron.normals)]
    edges = [
        np.concatenate([points[np.roll(face, -1)] - points[face] for face in solid.polyhedron.faces])
        for points, solid in ((points_a, solid_a), (points_b, solid_b))
    ]
    products = np.cross(edges[0][:, None], edges[1][None]).reshape(-1, 3)
    axes = np.vstack([*axes, products])
    lengths = np.linalg.norm(axes, axis=1)
    axes = axes[lengths > 1e-9] / lengths[lengths > 1e-9, None]
    a, b = points_a @ axes.T, points_b @ axes.T
    return np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0)).min()


@pytest.mark.parametrize("seed", range(5))
def test_the_pairs_of_edges_left_out_have_no_say(seed):
    """Against every pair of edges, on random hulls and boxes, turned at random or alike; many poses at once."""
    rng = np.random.default_rng(seed)
    hull = convex_polyhedron(rng.normal(size=(25, 3)) * [0.5, 0.4, 0.3])
    vertices = hull.vertices - mass_properties(hull.vertices, triangles(hull)).centroid
    hull = convex_polyhedron(vertices)
    hull = Solid(hull.vertices, triangles(hull), hull, None)
    for first, second in ((hull, hull), (hull, CUBE), (_solid([0.8, 1.2, 1.0], 0.1), CUBE)):
        rotations = Rotation.random(20, random_state=seed)
        rotations_a = Rotation.concatenate([rotations[:10], Rotation.identity(10)])
        offsets = rng.normal(size=(20, 3)) * 0.5
        depths = penetration_depths(
            first, offsets + 1.0, rotations_a.as_quat(scalar_first=True),
            second, 2.0 * offsets + 1.0, rotations.as_quat(scalar_first=True),
        )  # fmt: skip
        for k in range(20):
            expected = _depth_by_every_axis(first, rotations_a[k], second, rotations[k], offsets[k])
            if expected > 0.0:
                assert depths[k] == pytest.approx(expected, abs=ROUNDING)
            else:
                # apart: any separating axis bounds the clearance from below
                assert expected - ROUNDING <= depths[k] <= ROUNDING
        assert (depths > 0.0).sum() > 5


def test_large_hulls_need_little_memory():
    """Two spheres of 640 corners and 1900 edges each: 3.7 million pairs of edges, known depth."""
    sphere = trimesh.creation.icosphere(3, 0.5)
    ball = convex_polyhedron(np.array(sphere.vertices))
    ball = Solid(ball.vertices, triangles(ball), ball, None)
    tracemalloc.start()
    depth = penetration_depth(
        ball, np.zeros(3), UPRIGHT, ball, np.array([0.9, 0.1, 0.2]), _turned([1, 2, 3], 25.0)
    )
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # facets lie up to (edge / sqrt(3))^2 / 2 / radius inside the sphere, edges are 0.08 m
    assert depth == pytest.approx(1.0 - np.linalg.norm([0.9, 0.1, 0.2]), abs=2.0 * 0.08**2 / 6.0 / 0.5)
    assert peak < 1e8


def test_near_pairs_are_those_whose_bounding_boxes_meet():
    rng = np.random.default_rng(4)
    solids = [CUBE if k % 2 else _solid([0.2, 1.2, 0.5], 0.02) for k in range(60)]
    position = rng.random((60, 3)) * [6.0, 3.0, 3.0]
    rotation = Rotation.random(60, random_state=4)
    corners = [rotation[k].apply(solids[k].vertices) + position[k] for k in range(60)]
    expected = [
        (a, b)
        for a in range(60)
        for b in range(a + 1, 60)
        if (corners[a].min(axis=0) - 0.01 <= corners[b].max(axis=0)).all()
        and (corners[b].min(axis=0) - 0.01 <= corners[a].max(axis=0)).all()
    ]
    pairs = near_pairs(solids, position, rotation.as_quat(scalar_first=True), 0.01)
    assert 20 < len(expected) < 800
    np.testing.assert_array_equal(pairs, expected)
    assert near_pairs(solids[:1], position[:1], rotation.as_quat(scalar_first=True)[:1], 0.01).shape == (0, 2)


def test_order_frame_and_distance_do_not_matter():
    block = _solid([0.8, 2.4, 1.6], 0.02)
    rotation = Rotation.from_rotvec([0.3, -0.2, 0.5])
    offset = np.array([0.9, 0.2, 0.9])
    plain = penetration_depth(CUBE, np.zeros(3), UPRIGHT, block, offset, UPRIGHT)
    turned = rotation.as_quat(scalar_first=True)
    moved = penetration_depth(CUBE, np.ones(3), turned, block, np.ones(3) + rotation.apply(offset), turned)
    swapped = penetration_depth(block, offset, UPRIGHT, CUBE, np.zeros(3), UPRIGHT)
    assert moved == pytest.approx(plain, abs=ROUNDING)
    assert swapped == pytest.approx(plain, abs=ROUNDING)


def test_far_apart_is_a_lower_bound_of_the_clearance():
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, np.array([10.0, 0.0, 0.0]), UPRIGHT)
    assert -9.0 - ROUNDING <= depth < -8.0
