import dataclasses

import numpy as np
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.pages.scene.projection import VIEWS, Scene


def test_views_are_right_handed_turns():
    for axes in VIEWS.values():
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize(("view", "across"), [("front", 0), ("side", 1)])
def test_an_elevation_shows_the_face_that_looks_to_the_eye(make_structure, view, across):
    structure = make_structure([{"name": "a", "shape": "sharp", "position": [0.3, -0.2, 0.8]}])
    outlines, bodies, _ = Scene(structure, view).faces(structure.position, structure.orientation)
    assert bodies == [0, 1]
    half = np.array([0.8, 2.4])[across] / 2
    middle = np.array([0.3, -0.2])[across]
    np.testing.assert_allclose(outlines[1].min(axis=0), [middle - half, 0.0], atol=1e-12)
    np.testing.assert_allclose(outlines[1].max(axis=0), [middle + half, 1.6], atol=1e-12)


def test_what_is_nearer_comes_later_and_the_driven_body_first(make_structure):
    bodies = [
        {"name": "near", "shape": "cube", "position": [0.0, -1.0, 0.5]},
        {"name": "far", "shape": "cube", "position": [0.0, 1.0, 0.5]},
    ]
    structure = make_structure(bodies)
    _, order, _ = Scene(structure, "front").faces(structure.position, structure.orientation)
    assert order == [0, 2, 1]


def test_a_wide_block_on_two_walls_hides_their_tops():
    structure = load_structure("configuration-3")
    _, order, _ = Scene(structure, "3d").faces(structure.position, structure.orientation)
    last = {structure.body_names[body]: place for place, body in enumerate(order)}
    assert last["slab"] < last["wall-a-1"]
    assert last["wall-a-4"] < last["wall-b-4"] < last["top"]


def test_a_box_shows_three_faces_in_parallel_projection(make_structure):
    structure = make_structure([{"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.5]}])
    _, bodies, light = Scene(structure, "3d").faces(structure.position, structure.orientation)
    assert bodies == [0, 0, 0, 1, 1, 1]
    assert len(set(np.round(light, 6))) == 3


def test_the_extent_holds_every_pose(leaning_run):
    run, structure = leaning_run
    low, high = Scene(structure, "front").extent(run["position"].to_numpy(), run["orientation"].to_numpy())
    np.testing.assert_allclose(low, [-1.5, -0.2], atol=1e-12)
    assert high[0] == pytest.approx(1.6)  # the slab, 0.1 m on
    assert 3.2 < high[1] < 3.2 + 0.8 * 0.05


def test_a_shape_that_is_not_convex_is_seen_by_its_triangles(make_structure):
    structure = make_structure([{"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.5]}])
    solids = {**structure.solids, "cube": dataclasses.replace(structure.solids["cube"], polyhedron=None)}
    structure = dataclasses.replace(structure, solids=solids)
    outlines, bodies, _ = Scene(structure, "front").faces(structure.position, structure.orientation)
    assert bodies == [0, 1, 1]
    front = np.concatenate(outlines[1:])
    assert len(front) == 6
    np.testing.assert_allclose([front.min(axis=0), front.max(axis=0)], [[-0.5, 0.0], [0.5, 1.0]], atol=1e-12)
