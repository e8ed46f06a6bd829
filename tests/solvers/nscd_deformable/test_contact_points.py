"""Points of a joint, and the patch test on meshes that do not match."""

import numpy as np
import pytest

from blockshake.jit import kernel
from blockshake.solvers.nscd.parameters import DeformableParameters
from blockshake.solvers.nscd_deformable.contact_points import joint_points
from blockshake.solvers.nscd_deformable.elastic_bodies import anchor_into, pack_elastic
from blockshake.solvers.nscd_deformable.shapes import elastic_shapes

# compiled
joint_points = kernel(joint_points)

SQUARE = np.array([[0.0, 0.0, 0.0], [0.76, 0.0, 0.0], [0.76, 2.36, 0.0], [0.0, 2.36, 0.0]])


def test_a_joint_of_the_papers_blocks_has_three_by_seven_points():
    points, gaps, areas = joint_points(SQUARE, np.arange(4.0), 4, 0.4)
    assert len(points) == 21
    assert areas.sum() == pytest.approx(0.76 * 2.36)
    assert areas @ points == pytest.approx(0.76 * 2.36 * SQUARE.mean(axis=0))
    for corner in range(4):
        assert gaps[np.abs(points - SQUARE[corner]).sum(axis=1).argmin()] == corner


@pytest.mark.parametrize(("count", "expected"), [(4, 4), (3, 3), (2, 2), (1, 1)])
def test_wide_spacing_leaves_the_corners(count, expected):
    points, _, _ = joint_points(SQUARE, np.zeros(4), count, 10.0)
    assert len(points) == expected


def test_an_edge_is_cut_into_equal_parts():
    points, gaps, _ = joint_points(SQUARE[1:], np.array([0.0, 1.0, 0.0, 0.0]), 2, 0.4)
    assert len(points) == 7
    assert np.sort(points[:, 1]) == pytest.approx(np.linspace(0.0, 2.36, 7))
    assert np.sort(gaps) == pytest.approx(np.linspace(0.0, 1.0, 7))


def test_meshes_that_do_not_match_pass_the_patch_test(stone):
    """Blocks of 0.9 and 1.1 m, whose lattices share no line: any uniform strain of both leaves all points together.

    Then points carry the works of any uniform stress without loss (Taylor and Papadopoulos 1991): both sides
    interpolate a linear displacement exactly, wherever the point is.
    """
    bodies = [
        {"name": "lower", "shape": "wide", "position": [0.0, 0.0, 0.55]},
        {"name": "upper", "shape": "narrow", "position": [0.05, 0.02, 1.55]},
    ]
    shapes = {"wide": {"box": [1.1, 1.1, 1.1]}, "narrow": {"box": [0.9, 0.9, 0.9], "chamfer": 0.02}}
    structure = stone(bodies, shapes=shapes)
    parameters = DeformableParameters(mesh_size=0.25, contact_spacing=0.25)
    elastic = pack_elastic(structure, np.arange(3), parameters, False)
    strain = np.array([[1.0, 0.3, -0.2], [0.1, -0.5, 0.4], [0.2, 0.6, 0.7]])
    corners = structure.position[2] + np.array([[x, y, -0.45] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]) * [
        0.43, 0.43, 1.0,
    ]  # fmt: skip
    points, _, _ = joint_points(corners, np.zeros(4), 4, 0.25)
    for body, up in ((1, 1.0), (2, -1.0)):
        box = structure.file.shapes[structure.file.bodies[body].shape].box
        lattice = elastic_shapes(box, 0.2, 0.25, 0.25, 12).lattice
        mesh = elastic_shapes(box, 0.2, 0.25, 0.25, 12).mesh
        moved = (mesh.nodes[lattice.nodes] + structure.position[body]) @ strain.T
        at, weights = np.empty(4, np.int64), np.empty(4)
        for point in points:
            anchor_into(
                elastic, body, point - structure.position[body], np.array([0.0, 0.0, up]), at, weights
            )
            assert weights.sum() == pytest.approx(1.0)
            assert weights @ moved[at - elastic.first_point[body]] == pytest.approx(strain @ point, abs=1e-12)
