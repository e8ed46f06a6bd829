"""Contact faces at the start against areas that are known by hand, and without a compiled kernel."""

import subprocess
import sys

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.files import PACKAGE
from blockshake.forces.faces import find_faces
from blockshake.geometry.structure import build_structure

HALF = 0.5  # m, of a cube


def _faces(make_mapping, *bodies, **keys):
    return find_faces(build_structure(make_mapping(list(bodies), **keys), "faces.yaml", "."))


def _cube(name, x, z, yaw=0.0):
    body = {"name": name, "shape": "cube", "position": [x, 0.0, z]}
    return body | ({"orientation": [np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)]} if yaw else {})


def test_a_block_on_a_slab_bears_on_its_flat_within_the_chamfer(make_mapping):
    (face,) = _faces(make_mapping, {"name": "upper", "shape": "block", "position": [0.3, 0.0, 0.8]})
    assert (face.name, face.half_width) == ("slab-upper", pytest.approx(0.4 - 0.02, abs=1e-12))
    np.testing.assert_allclose(np.ptp(face.corners, axis=0), [0.76, 2.36, 0.0], atol=1e-12)
    np.testing.assert_allclose(face.on_upper, [0.0, 0.0, -0.8], atol=1e-12)
    np.testing.assert_allclose(face.axes, np.eye(3), atol=1e-12)


def test_a_block_across_two_bears_on_its_share_of_each(make_mapping):
    faces = _faces(make_mapping, _cube("a", -0.6, HALF), _cube("b", 0.6, HALF), _cube("c", 0.0, 1.5))
    above = {face.name: face for face in faces if face.name.endswith("-c")}
    assert set(above) == {"a-c", "b-c"}
    for name, side in (("a-c", -1.0), ("b-c", 1.0)):
        # from 0.1 m off the middle of the upper block to its edge
        assert above[name].half_width == pytest.approx(0.2, abs=1e-12)
        np.testing.assert_allclose(above[name].on_upper, [side * 0.3, 0.0, -HALF], atol=1e-12)


def test_a_cube_turned_by_an_eighth_on_another_bears_on_an_octagon(make_mapping):
    face = _faces(make_mapping, _cube("a", 0.0, HALF), _cube("b", 0.0, 1.5, np.pi / 4.0))[-1]
    assert len(face.corners) == 8
    # two squares with one middle, one turned by 45 degrees: all corners at the half width over cos(22.5 degrees)
    np.testing.assert_allclose(np.linalg.norm(face.corners, axis=1), HALF / np.cos(np.pi / 8.0), rtol=1e-9)
    np.testing.assert_allclose(face.on_upper, [0.0, 0.0, -HALF], atol=1e-12)


def test_a_shape_that_is_not_convex_is_named(make_mapping, tmp_path):
    # a tetrahedron whose first face is pushed in
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.2, 0.2, 0.2)]
    faces = [(1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 5), (3, 4, 5), (4, 2, 5)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a} {b} {c}" for a, b, c in faces]
    (tmp_path / "dented.obj").write_text("\n".join(lines) + "\n")
    mapping = make_mapping(
        [{"name": "upper", "shape": "dented", "position": [0.0, 0.0, 1.0]}],
        shapes={"dented": {"mesh": "dented.obj"}},
    )
    structure = build_structure(mapping, "faces.yaml", tmp_path)
    with pytest.raises(InputError, match=r"shapes\.dented: expected a convex shape"):
        find_faces(structure)


def test_no_kernel_is_compiled_for_it():
    code = (
        "import numba.core.dispatcher as d\n"
        "def refuse(*_): raise AssertionError('a kernel was compiled')\n"
        "d.Dispatcher.compile = refuse\n"
        "from blockshake.geometry.structure import load_structure\n"
        "from blockshake.forces.faces import find_faces\n"
        "print(len(find_faces(load_structure('configuration-2'))))\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=PACKAGE.parents[1]
    )
    assert run.stdout.split() == ["4"]
