import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.joints import contact_normals, find_joints, joint_coordinates

CUBE = {"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.5]}


@pytest.fixture(scope="module")
def structure():
    return load_structure("configuration-1")


def _still(structure, n_times):
    n_bodies = len(structure.mass)
    return np.tile(structure.position, (n_times, 1, 1)), np.tile(np.eye(3), (n_times, n_bodies, 1, 1))


def test_joints_of_a_stack_lie_between_its_blocks(structure):
    pairs, centres = find_joints(structure)
    np.testing.assert_array_equal(pairs, [[0, 1], [1, 2], [2, 3]])
    tops = structure.position[1:, 2] - 0.8
    np.testing.assert_allclose(centres[:, 2], tops, atol=1e-12)
    np.testing.assert_allclose(centres[:, :2], structure.position[1:, :2], atol=1e-12)


def test_every_joint_tells_its_own_motion(structure):
    """The second block slides by 5 mm on the first; the third rides on it and does nothing."""
    position, rotation = _still(structure, 2)
    position[1, 2:] += [0.005, -0.002, 0.0]
    found = joint_coordinates(structure, position, rotation)
    np.testing.assert_allclose(found["slip"][1, :, 0], [0.0, 0.005, 0.0], atol=1e-15)
    np.testing.assert_allclose(found["slip"][1, :, 1], [0.0, -0.002, 0.0], atol=1e-15)
    assert np.abs(found["opening"]).max() < 1e-15
    assert np.abs(found["rotation"]).max() < 1e-15


def test_rocking_about_an_edge_opens_the_centre_by_half_the_width(structure):
    """The whole stack turns by theta about an edge of the lowest block: opening b sin, slip b (1 - cos)."""
    theta, b = 0.02, 0.4
    position, rotation = _still(structure, 2)
    turn = Rotation.from_rotvec([0.0, theta, 0.0]).as_matrix()
    _, centres = find_joints(structure)
    edge = centres[0] + [b, 0.0, 0.0]
    position[1, 1:] = edge + (position[0, 1:] - edge) @ turn.T
    rotation[1, 1:] = turn
    found = joint_coordinates(structure, position, rotation)
    assert float(found["opening"][1, 0]) == pytest.approx(b * np.sin(theta), rel=1e-12)
    assert float(found["slip"][1, 0, 0]) == pytest.approx(b * (1.0 - np.cos(theta)), rel=1e-9)
    np.testing.assert_allclose(found["rotation"][1, 0], [0.0, theta, 0.0], atol=1e-12)
    np.testing.assert_allclose(found["rotation"][1, 1:], 0.0, atol=1e-12)
    assert np.abs(found["opening"][1, 1:]).max() < 1e-12


def test_a_frame_that_moves_with_everything_changes_nothing(structure):
    position, rotation = _still(structure, 2)
    turn = Rotation.from_rotvec([0.1, -0.2, 0.3]).as_matrix()
    position[1] = position[0] @ turn.T + [1.0, 2.0, 3.0]
    rotation[1] = turn
    found = joint_coordinates(structure, position, rotation)
    for name in ("slip", "opening", "rotation"):
        assert np.nanmax(np.abs(found[name])) < 1e-12


def test_what_is_not_known_stays_unknown(structure):
    position, rotation = _still(structure, 2)
    position[1, 2], rotation[1, 2] = np.nan, np.nan
    found = joint_coordinates(structure, position, rotation)
    assert np.isnan(found["opening"][1, 1:]).all()
    assert float(found["opening"][1, 0]) == 0.0


def test_normal_of_a_stack_points_up_and_of_neighbours_across(make_structure):
    bodies = [
        CUBE,
        {"name": "b", "shape": "cube", "position": [0.2, 0.0, 1.5]},
        {"name": "c", "shape": "cube", "position": [1.0, 0.3, 0.5]},
    ]
    structure = make_structure(bodies)
    pairs = np.array([[0, 1], [1, 2], [2, 1], [1, 3]])
    expected = [[0, 0, 1], [0, 0, 1], [0, 0, -1], [1, 0, 0]]
    np.testing.assert_allclose(contact_normals(structure, pairs), expected, atol=1e-12)


def test_normal_leans_with_the_face(make_structure):
    angle = 0.2
    turn = [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0]
    up = np.array([np.sin(angle), 0.0, np.cos(angle)])
    bodies = [
        {**CUBE, "position": [0.0, 0.0, 2.0], "orientation": turn},
        {
            "name": "b",
            "shape": "cube",
            "position": (np.array([0.0, 0.0, 2.0]) + up).tolist(),
            "orientation": turn,
        },
    ]
    structure = make_structure(bodies, slab=False)
    np.testing.assert_allclose(contact_normals(structure, [(0, 1)]), [up], atol=1e-12)


def test_normal_of_a_shape_that_is_not_convex_is_not_told(make_structure):
    structure = make_structure([CUBE])
    hollow = dataclasses.replace(structure.solids["cube"], polyhedron=None)
    structure = dataclasses.replace(structure, solids={**structure.solids, "cube": hollow})
    assert np.isnan(contact_normals(structure, [(0, 1)])).all()
