"""Convex meshes as shapes, from file to trajectory."""

import numpy as np
import pytest
import trimesh

from blockshake.dynamics.motion import ground_motion

G = 9.81
RADIUS, HEIGHT = 0.5, 2.0
APOTHEM = RADIUS * np.cos(np.pi / 6.0)


@pytest.fixture(scope="module")
def hexagon(tmp_path_factory):
    """File of a regular prism of six sides, corners of the hexagon at 0, 60, ... degrees."""
    path = tmp_path_factory.mktemp("meshes") / "prism.ply"
    trimesh.creation.cylinder(radius=RADIUS, height=HEIGHT, sections=6).export(path)
    return path


def about_z(angle):
    return [np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)]


def test_mesh_of_a_box_moves_as_the_box(scene, simulate, tmp_path):
    # edges that a file in single precision holds exactly; split triangles leave corners inside the faces
    mesh = trimesh.creation.box([0.5, 1.0, 2.0]).subdivide()
    mesh.apply_translation([0.25, -0.5, 1.0])
    mesh.export(tmp_path / "box.stl")
    shapes = {"box": {"box": [0.5, 1.0, 2.0]}, "mesh": {"mesh": "box.stl"}}
    time = np.linspace(0.0, 2.0, 401)
    motion = ground_motion("sine", time, {"x": 4.0 * np.sin(8.0 * time)}, "acceleration")
    runs = []
    for shape in shapes:
        bodies = [{"name": f"b{i}", "shape": shape, "position": [0, 0, 1.0 + 2.0 * i]} for i in range(2)]
        structure = scene(shapes, bodies, friction=0.6, folder=tmp_path)
        np.testing.assert_allclose(structure.mass[1], 2400.0, rtol=1e-9)
        runs.append(simulate(structure, 1.2, motion=motion))
    assert np.abs(runs[0].orientation[:, 1:, 2]).max() > 5e-3
    # corners come in another order, and so does the rounding, which rocking amplifies
    np.testing.assert_allclose(runs[1].position, runs[0].position, atol=1e-7)


def test_two_turned_prisms_stand_on_each_other(hexagon, scene, simulate):
    # the overlap of two hexagons at 30 degrees has twelve corners, of which four carry
    shapes = {"prism": {"mesh": hexagon.name}}
    bodies = [
        {"name": "low", "shape": "prism", "position": [0, 0, HEIGHT / 2]},
        {
            "name": "high",
            "shape": "prism",
            "position": [0, 0, 1.5 * HEIGHT],
            "orientation": about_z(np.pi / 6),
        },
    ]
    structure = scene(shapes, bodies, folder=hexagon.parent)
    np.testing.assert_allclose(structure.mass[1], 1.5 * np.sqrt(3) * RADIUS**2 * HEIGHT * 2400.0, rtol=1e-6)
    run = simulate(structure, 2.0)
    assert np.abs(run.position - run.position[0]).max() < 1e-8
    np.testing.assert_allclose(run.joint_force[-1, :, 2], structure.mass[1] * G * np.array([2, 1]), rtol=1e-6)


@pytest.mark.parametrize(("turn", "half_width"), [(np.pi / 6, APOTHEM), (0.0, RADIUS)])
@pytest.mark.parametrize(("share", "lifts"), [(0.98, False), (1.02, True)])
def test_prism_lifts_over_its_side_or_its_corner(
    share, lifts, turn, half_width, hexagon, scene, simulate, push
):
    # a rigid body lifts off when the floor accelerates by more than g b / h of the side or corner it turns about
    body = {"name": "b", "shape": "prism", "position": [0, 0, HEIGHT / 2], "orientation": about_z(turn)}
    structure = scene({"prism": {"mesh": hexagon.name}}, [body], friction=2.0, folder=hexagon.parent)
    run = simulate(structure, 0.5, motion=push(share * G * half_width / (HEIGHT / 2), 0.6, 1.0))
    rise = run.position[:, 1, 2].max() - HEIGHT / 2
    assert (rise > 1e-5) == lifts
    if not lifts:
        assert rise < 1e-8
