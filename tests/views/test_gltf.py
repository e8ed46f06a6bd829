"""The .glb is read by trimesh, and its animation from the bytes, after glTF 2.0, section 4.4 and 3.11."""

import json
import struct

import numpy as np
import pytest
import trimesh

from blockshake.views.gltf import write_glb


@pytest.fixture(scope="module")
def glb(leaning_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("glb") / "run.glb"
    write_glb(path, *leaning_run)
    return path


def parts(path):
    """JSON and binary chunk of a .glb."""
    content = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIIII", content)
    assert (magic, version, length, kind) == (b"glTF", 2, len(content), 0x4E4F534A)
    return json.loads(content[20 : 20 + size]), content[28 + size :]


def values(tree, binary, number):
    """Numbers of an accessor."""
    accessor = tree["accessors"][number]
    view = tree["bufferViews"][accessor["bufferView"]]
    columns = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    found = np.frombuffer(binary, "<f4", accessor["count"] * columns, view.get("byteOffset", 0))
    return found.reshape(accessor["count"], columns)


def test_trimesh_sees_the_blocks_where_the_run_starts_with_y_up(glb, leaning_run):
    scene = trimesh.load(glb)
    assert set(scene.geometry) == {"slab", "lower", "upper"}
    np.testing.assert_allclose(scene.bounds, [[-1.5, -0.2, -1.5], [1.5, 3.2, 1.5]], atol=1e-6)
    solid = leaning_run[1].solid(2)
    transform, name = scene.graph["upper"]
    assert scene.geometry[name].volume == pytest.approx(solid.properties.volume, rel=1e-5)
    np.testing.assert_allclose(transform[:3, 3], [0.0, 2.4, 0.0], atol=1e-6)


def test_the_animation_has_the_poses_of_the_run(glb, leaning_run):
    run = leaning_run[0]
    tree, binary = parts(glb)
    (animation,) = tree["animations"]
    seen = set()
    for channel in animation["channels"]:
        node = tree["nodes"][channel["target"]["node"]]
        sampler = animation["samplers"][channel["sampler"]]
        assert "matrix" not in node
        assert sampler["interpolation"] == "LINEAR"
        np.testing.assert_allclose(values(tree, binary, sampler["input"])[:, 0], run["time"], rtol=1e-6)
        found = values(tree, binary, sampler["output"])
        own = run.sel(body=node["name"])
        if channel["target"]["path"] == "translation":
            np.testing.assert_allclose(found, own["position"], atol=1e-6)
        else:
            np.testing.assert_allclose(found, own["orientation"].sel(quaternion=list("xyzw")), atol=1e-6)
        seen.add((node["name"], channel["target"]["path"]))
    assert len(seen) == 6
    times = tree["accessors"][animation["samplers"][0]["input"]]
    assert (times["min"], times["max"]) == ([0.0], [1.0])


def test_same_run_same_bytes(glb, leaning_run, tmp_path):
    write_glb(tmp_path / "again.glb", *leaning_run)
    assert (tmp_path / "again.glb").read_bytes() == glb.read_bytes()


def test_a_run_in_national_coordinates_counts_from_a_local_origin(leaning_run, tmp_path):
    """32 bits are 0.25 m apart at 4000 km: the same bytes of motion as at the origin, and the origin said."""
    run, structure = leaning_run
    origin = np.array([500_000.0, 4_000_000.0, 0.0])
    write_glb(tmp_path / "far.glb", run.assign(position=run["position"] + origin), structure)
    tree, binary = parts(tmp_path / "far.glb")
    assert tree["asset"]["extras"]["local_origin"] == origin.tolist()
    (animation,) = tree["animations"]
    for channel in animation["channels"]:
        if channel["target"]["path"] == "translation":
            node = tree["nodes"][channel["target"]["node"]]
            found = values(tree, binary, animation["samplers"][channel["sampler"]]["output"])
            np.testing.assert_allclose(found, run.sel(body=node["name"])["position"], atol=1e-6)
            np.testing.assert_allclose(node["translation"], found[0], atol=1e-6)
