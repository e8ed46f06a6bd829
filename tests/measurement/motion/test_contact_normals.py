import dataclasses

import numpy as np

from blockshake.measurement.motion.contact_normals import contact_normals

CUBE = {"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.5]}


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
