import numpy as np
import pytest
import trimesh

from blockshake.errors import InputError
from blockshake.geometry.overlap import find_pairs
from blockshake.jit import kernel
from blockshake.solvers.nscd.contact.detection import detect_pair_into
from blockshake.solvers.nscd.contact.overlap_polygon import choose_four_into, shrink_polygon_into
from blockshake.solvers.nscd.contact.polyhedra import empty_placed, pack_polyhedra, place_into

# compiled
detect_pair_into = kernel(detect_pair_into)

ROUNDING = 1e-12


def contacts_of(structure, margin=0.01, shrink=0.0, memory=None):
    polyhedra = pack_polyhedra(structure, np.arange(len(structure.mass)))
    placed = empty_placed(polyhedra)
    place_into(polyhedra, structure.position, structure.orientation, placed)
    memory = np.full((2, 2), -1, np.int64) if memory is None else memory
    normal, points, gaps, areas = np.empty(3), np.empty((5, 3)), np.empty(5), np.empty(5)
    count = detect_pair_into(
        polyhedra, placed, 0, 1, margin, shrink, 0.0, memory, normal, points, gaps, areas
    )
    return normal, points[:count], gaps[:count]


def quaternion(axis, angle):
    return [np.cos(0.5 * angle), *(np.sin(0.5 * angle) * np.array(axis, dtype=float))]


BLOCK = {"block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}}
CUBE = {"cube": {"box": [1.0, 1.0, 1.0]}}


def test_chamfered_block_touches_with_the_corners_of_its_flat(scene):
    normal, points, gaps = contacts_of(
        scene(BLOCK, [{"name": "b", "shape": "block", "position": [0, 0, 0.8]}])
    )
    np.testing.assert_allclose(normal, [0, 0, 1], atol=ROUNDING)
    np.testing.assert_allclose(np.abs(points), np.tile([0.38, 1.18, 0.0], (4, 1)), atol=ROUNDING)
    np.testing.assert_allclose(gaps, 0.0, atol=ROUNDING)


def test_shrink_draws_the_points_together(scene):
    structure = scene(BLOCK, [{"name": "b", "shape": "block", "position": [0, 0, 0.8]}])
    _, points, _ = contacts_of(structure, shrink=0.05)
    np.testing.assert_allclose(np.abs(points), np.tile([0.361, 1.121, 0.0], (4, 1)), atol=ROUNDING)


def test_overhang_is_clipped_at_the_lower_edge(scene):
    bodies = [
        {"name": "low", "shape": "cube", "position": [0, 0, 0.5]},
        {"name": "high", "shape": "cube", "position": [0.3, -0.2, 1.501]},
    ]
    normal, points, gaps = contacts_of(scene(CUBE, bodies, floor=False))
    np.testing.assert_allclose(normal, [0, 0, 1], atol=ROUNDING)
    np.testing.assert_allclose(
        [points.min(axis=0), points.max(axis=0)], [[-0.2, -0.5, 1.0005], [0.5, 0.3, 1.0005]]
    )
    np.testing.assert_allclose(gaps, 1e-3, atol=ROUNDING)


def test_tilted_block_touches_along_its_edge_and_a_corner_alone(scene):
    edge = quaternion([0, 1, 0], 0.2)
    height = 0.5 * (np.cos(0.2) + np.sin(0.2))
    _, points, gaps = contacts_of(
        scene(CUBE, [{"name": "b", "shape": "cube", "position": [0, 0, height], "orientation": edge}])
    )
    assert len(points) == 2
    np.testing.assert_allclose(sorted(points[:, 1]), [-0.5, 0.5], atol=ROUNDING)
    np.testing.assert_allclose(gaps, 0.0, atol=ROUNDING)
    corner = quaternion(np.array([1, -1, 0]) / np.sqrt(2), np.arccos(1 / np.sqrt(3)))
    normal, points, gaps = contacts_of(
        scene(
            CUBE,
            [{"name": "b", "shape": "cube", "position": [0, 0, 0.5 * np.sqrt(3)], "orientation": corner}],
        )
    )
    np.testing.assert_allclose(normal, [0, 0, 1], atol=ROUNDING)
    np.testing.assert_allclose(points, [[0, 0, 0]], atol=1e-9)
    np.testing.assert_allclose(gaps, 0.0, atol=1e-9)


def test_crossed_edges_touch_in_one_point(scene):
    # two cubes on their edges, the lower edge along y, the upper along x, 2 mm apart
    high = 0.5 * np.sqrt(2)
    bodies = [
        {
            "name": "low",
            "shape": "cube",
            "position": [0, 0, 0],
            "orientation": quaternion([0, 1, 0], np.pi / 4),
        },
        {
            "name": "high",
            "shape": "cube",
            "position": [0.1, 0.2, 2 * high + 0.002],
            "orientation": quaternion([1, 0, 0], np.pi / 4),
        },
    ]
    normal, points, gaps = contacts_of(scene(CUBE, bodies, floor=False))
    np.testing.assert_allclose(normal, [0, 0, 1], atol=ROUNDING)
    np.testing.assert_allclose(points, [[0.0, 0.2, high + 0.001]], atol=ROUNDING)
    np.testing.assert_allclose(gaps, [0.002], atol=ROUNDING)


def test_bodies_beyond_the_margin_or_beside_each_other_do_not_touch(scene):
    for position in ([0, 0, 1.011], [1.2, 1.2, 0.0], [1.011, 0, 0]):
        bodies = [
            {"name": "a", "shape": "cube", "position": [0, 0, 0]},
            {"name": "b", "shape": "cube", "position": position},
        ]
        assert len(contacts_of(scene(CUBE, bodies, floor=False))[1]) == 0


def test_turned_block_keeps_the_extent_of_the_octagon(scene):
    bodies = [
        {"name": "low", "shape": "cube", "position": [0, 0, 0]},
        {
            "name": "high",
            "shape": "cube",
            "position": [0, 0, 1],
            "orientation": quaternion([0, 0, 1], np.pi / 4),
        },
    ]
    _, points, _ = contacts_of(scene(CUBE, bodies, floor=False))
    assert len(points) == 4
    # corners of the octagon lie 0.54 m from its centre; two pairs of them far apart hold the extent
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), np.hypot(0.5, 0.5 * np.tan(np.pi / 8)))
    assert np.ptp(points[:, 0]) > 0.9
    assert np.ptp(points[:, 1]) > 0.9


def test_reduction_keeps_the_deepest_point():
    angles = np.arange(8) * np.pi / 4
    points = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(8)])
    chosen = np.empty(4, np.int64)
    for deepest in range(8):
        gaps = np.zeros(8)
        gaps[deepest] = -1e-5
        count = choose_four_into(points, gaps, 8, np.array([0.0, 0.0, 1.0]), chosen)
        assert count == 4
        assert deepest in chosen


def test_shrinking_keeps_the_centroid():
    polygon = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]])
    shrink_polygon_into(0.5, polygon, 3, np.empty(3))
    np.testing.assert_allclose(polygon.mean(axis=0), [1.0, 1.0, 0.0])
    np.testing.assert_allclose(polygon[1], [2.0, 0.5, 0.0])


def test_broad_phase_finds_the_pairs_of_a_wall(scene):
    bodies = [
        {"name": f"c{i}", "shape": "cube", "position": [1.5 * (i % 4), 0, 0.5 + i // 4]} for i in range(8)
    ]
    structure = scene(CUBE, bodies)
    polyhedra = pack_polyhedra(structure, np.arange(9))
    placed = empty_placed(polyhedra)
    place_into(polyhedra, structure.position, structure.orientation, placed)
    pairs = find_pairs(placed.low, placed.high, structure.driven, 1e-3)
    expected = [(0, i) for i in range(1, 5)] + [(i, i + 4) for i in range(1, 5)]
    assert [tuple(pair) for pair in pairs] == expected


def test_shape_that_is_not_convex_is_refused_by_name(scene, tmp_path):
    part = trimesh.creation.annulus(0.3, 0.5, 0.4)
    part.export(tmp_path / "ring.stl")
    structure = scene(
        {"ring": {"mesh": "ring.stl"}},
        [{"name": "r", "shape": "ring", "position": [0, 0, 2]}],
        folder=tmp_path,
    )
    with pytest.raises(InputError, match=r"shapes\.ring.*convex"):
        pack_polyhedra(structure, np.arange(2))


@pytest.mark.parametrize("offset", [[0.0, 0.0], [0.3, -0.2]])
def test_a_joint_with_a_layer_has_its_middle_too_and_the_layers_moments(scene, offset):
    """Points and areas integrate 1, x and x^2 over the overlap as the layer does: ``A``, centroid, ``A b^2 / 3``."""
    bodies = [
        {"name": "low", "shape": "cube", "position": [0, 0, 0.5]},
        {"name": "high", "shape": "cube", "position": [*offset, 1.5]},
    ]
    structure = scene(CUBE, bodies, floor=False)
    polyhedra = pack_polyhedra(structure, np.arange(2))
    placed = empty_placed(polyhedra)
    place_into(polyhedra, structure.position, structure.orientation, placed)
    normal, points, gaps, areas = np.empty(3), np.empty((5, 3)), np.empty(5), np.empty(5)
    memory = np.full((2, 2), -1, np.int64)
    count = detect_pair_into(polyhedra, placed, 0, 1, 0.01, 0.0, 1e-9, memory, normal, points, gaps, areas)
    assert count == 5
    sides, middle = 1.0 - np.abs(offset), 0.5 * np.array(offset)
    away = points[:, :2] - middle
    assert areas.sum() == pytest.approx(sides.prod(), rel=1e-6)
    np.testing.assert_allclose(areas @ away, 0.0, atol=1e-7)
    # the clipped polygon is wider by the 1e-9 m within which corners count as flush
    np.testing.assert_allclose(areas @ away**2, sides.prod() * sides**2 / 12.0, rtol=1e-6)
    assert areas @ away.prod(axis=1) == pytest.approx(0.0, abs=1e-7)
    np.testing.assert_allclose(gaps, 0.0, atol=ROUNDING)
