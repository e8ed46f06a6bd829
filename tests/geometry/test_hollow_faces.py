"""Boxes of hollow faces: nodes on the surface, a level set that is zero there, and no kink at the rim."""

import numpy as np
import pytest
from pydantic import ValidationError

from blockshake.errors import InputError
from blockshake.geometry.level_set import box_distance, hollow_box_distance
from blockshake.geometry.schema import Shape
from blockshake.geometry.surface_nodes import box_nodes
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

SIZE, CHAMFER, HOLLOW = np.array([0.8, 2.4, 1.6]), 0.02, 1e-3


def _distance(points, size=SIZE, chamfer=CHAMFER, hollow=HOLLOW):
    return np.array([hollow_box_distance(*point, *(size / 2.0), chamfer, hollow) for point in points])


def _of_hollow_block(make_structure, size, hollow):
    shapes = {"slab": {"box": [0.5, 0.5, 0.2]}, "block": {"box": size.tolist(), "hollow": hollow}}
    body = {"name": "b", "shape": "block", "position": [0.0, 0.0, float(size[2]) / 2.0]}
    return make_structure([body], shapes=shapes)


def test_nodes_lie_on_the_hollow_face():
    points, areas = box_nodes(SIZE, CHAMFER, HOLLOW, 0.2, 0.005)
    assert np.abs(_distance(points)[:, 0]).max() < 1e-15
    flat, flat_areas = box_nodes(SIZE, CHAMFER, 0.0, 0.2, 0.005)
    np.testing.assert_array_equal(areas, flat_areas)
    lowered = np.linalg.norm(points - flat, axis=1)
    # in the middle by the whole hollow; an inset of 5 mm from a rim by less than a thousandth of it
    assert lowered.max() == pytest.approx(HOLLOW, rel=1e-12)
    at_rim = (np.abs(flat) > SIZE / 2.0 - 0.0251).sum(axis=1) > 1
    assert at_rim.sum() > 100
    assert 0.0 < lowered[at_rim].max() < 1e-3 * HOLLOW


def test_faces_meet_the_chamfer_where_flat_ones_do():
    rim = np.array([[0.38, y, 0.8] for y in np.linspace(-1.18, 1.18, 50)])
    assert np.abs(_distance(rim)[:, 0]).max() < 1e-15


def test_it_differs_from_the_flat_box_by_the_hollow_at_most():
    points = (np.random.default_rng(5).random((2000, 3)) - 0.5) * (SIZE + 0.02)
    flat = np.array([box_distance(*point, *(SIZE / 2.0), CHAMFER) for point in points])
    hollow = _distance(points)
    more = hollow[:, 0] - flat[:, 0]
    assert (more >= 0.0).all()
    assert 0.5 * HOLLOW < more.max() <= HOLLOW
    np.testing.assert_allclose(np.linalg.norm(hollow[:, 1:], axis=1), 1.0, rtol=1e-12)


def test_no_slope_is_steeper_than_the_lists_of_near_nodes_take(make_structure):
    """A list holds the nodes below ``steepest`` times the skin: the level set may not change faster."""
    size, hollow = np.array([0.05, 0.05, 0.05]), 5e-4
    structure = _of_hollow_block(make_structure, size, hollow)
    surfaces = assemble_surfaces(structure, LsDemParameters(node_spacing=0.02, perimeter_inset=0.02))
    limit = surfaces.steepest[surfaces.shape[1]]
    rng = np.random.default_rng(6)
    points = (rng.random((20000, 3)) - 0.5) * 0.06
    step = 1e-5 * rng.standard_normal(points.shape)
    change = _distance(points + step, size, 0.0, hollow)[:, 0] - _distance(points, size, 0.0, hollow)[:, 0]
    slope = np.abs(change) / np.linalg.norm(step, axis=1)
    assert 1.0 < slope.max() <= limit < 1.01


def test_hollow_faces_are_those_of_boxes_and_shallow():
    with pytest.raises(ValidationError, match="hollow faces of a box only"):
        Shape(mesh="a.stl", hollow=1e-3)
    with pytest.raises(ValidationError, match="at most a hundredth"):
        Shape(box=(0.8, 2.4, 1.6), hollow=0.0081)


def test_a_sampled_level_set_refuses_hollow_faces(make_structure):
    structure = _of_hollow_block(make_structure, SIZE, HOLLOW)
    with pytest.raises(InputError, match="expected the exact distance with hollow faces"):
        assemble_surfaces(structure, LsDemParameters(level_set="grid"))
