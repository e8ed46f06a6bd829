"""Mesh files with mutations are refused in one line, or have the mass that an independent reading of them gives."""

import struct

import numpy as np
import pytest
import trimesh
from contract import read_or_refused, scratch
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_bytes, mutated_texts, mutations
from solid_angles import box, points_in_box, winding_numbers

from blockshake.geometry.structure import build_structure

DENSITY = 2400.0
SOLID = np.concatenate([box((1.0, 0.8, 0.6)), box((0.3, 0.4, 0.5), (1.2, 0.1, 0.05)) * [1.0, 1.0, -1.0]])
SOLID[12:] = SOLID[12:, ::-1]  # mirrored
# numbers of a mesh, put in place of others: a corner moves, a surface crosses itself, a part moves into another
WORDS = (
    "0",
    "-0",
    "0.1",
    "-0.25",
    "1.2",
    "-3",
    "1e3",
    "0,5",
    "nan",
    "1e-9",
    "1e200",
    "x",
    "1 2",
    "",
    "f 1 2 3",
    "\n",
)
STRUCTURE = {
    "name": "test",
    "materials": {"stone": {"density": DENSITY, "youngs_modulus": 3e10, "poisson_ratio": 0.2}},
    "bodies": [{"name": "a", "shape": "a", "material": "stone", "position": [0, 0, 0]}],
}


def _good(suffix, **how):
    mesh = trimesh.Trimesh(SOLID.reshape(-1, 3), np.arange(3 * len(SOLID)).reshape(-1, 3), process=False)
    mesh.merge_vertices()
    content = mesh.export(file_type=how.pop("file_type", suffix[1:]), **how)
    return suffix, content if isinstance(content, bytes) else content.encode()


GOOD = {
    "STL": _good(".stl"),
    "STL text": _good(".stl", file_type="stl_ascii"),
    "OBJ": _good(".obj"),
    "OFF": _good(".off"),
    "PLY": _good(".ply"),
    "PLY text": _good(".ply", encoding="ascii"),
}


def corners_of(kind, content):
    """Triangles of a file read by rule and line, shape (n, 3, 3); raises where it is not what it states."""
    if kind == "STL":
        (count,) = struct.unpack_from("<I", content, 80)
        values = np.frombuffer(
            content[84:], dtype=np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
        )
        assert len(values) == count
        return values["c"].astype(float)
    if kind == "PLY":
        head, _, body = content.partition(b"end_header\n")
        n_vertices, n_faces = (int(head.split(name)[1].split()[0]) for name in (b"vertex", b"element face"))
        vertices = np.frombuffer(body, "<f4", 3 * n_vertices).reshape(-1, 3)
        faces = np.frombuffer(body[12 * n_vertices :], np.dtype([("k", "u1"), ("v", "<i4", 3)]), n_faces)
        assert (faces["k"] == 3).all()
        return vertices.astype(float)[faces["v"]]
    lines = [line.split() for line in content.decode().splitlines()]
    if kind == "STL text":
        values = [[float(word) for word in line[1:4]] for line in lines if line[:1] == ["vertex"]]
        return np.array(values).reshape(-1, 3, 3)
    if kind == "OBJ":
        vertices = np.array([[float(word) for word in line[1:4]] for line in lines if line[:1] == ["v"]])
        faces = [[int(word.split("/")[0]) for word in line[1:4]] for line in lines if line[:1] == ["f"]]
        return vertices[np.array(faces) - 1]
    if kind == "OFF":
        words = [line for line in lines[1:] if line and not line[0].startswith("#")]
        n_vertices, n_faces = map(int, words[0][:2])
    else:
        begin = lines.index(["end_header"])
        counts = {line[1]: int(line[2]) for line in lines[:begin] if line[:1] == ["element"]}
        n_vertices, n_faces, words = counts["vertex"], counts["face"], [None, *lines[begin + 1 :]]
    vertices = np.array([[float(word) for word in line[:3]] for line in words[1 : n_vertices + 1]])
    faces = [list(map(int, line[1:4])) for line in words[n_vertices + 1 : n_vertices + 1 + n_faces]]
    return vertices[np.array(faces)]


def held_against_its_values(kind, content):
    """Whether a mesh file is read; then its mass is that of the triangles which the file states, wound once."""
    suffix, masses = GOOD[kind][0], []
    with scratch() as folder:
        with open(f"{folder}/m{suffix}", "wb") as file:
            file.write(content)
        mapping = STRUCTURE | {"shapes": {"a": {"mesh": f"m{suffix}"}}}
        if not read_or_refused(lambda: masses.append(build_structure(mapping, "s", folder).mass[0]), folder):
            return False
    try:
        corners = corners_of(kind, content)
    except (AssertionError, ValueError, IndexError, KeyError, struct.error):
        # not as the format states in a way that its reader passes over: the surface is then the good one's or none
        corners = SOLID
    centre = corners.mean(axis=(0, 1))
    stated = DENSITY * np.linalg.det(corners - centre).sum() / 6.0
    assert masses[0] == pytest.approx(stated, rel=1e-5)
    points, _ = points_in_box(corners, 400)
    winding = winding_numbers(corners, points)
    # but for points within the rounding of a surface
    assert (np.abs(winding - (winding > 0.5)) < 1e-4).mean() > 0.99
    return True


def damaged(kind):
    """Mutations of a good mesh file."""
    content = GOOD[kind][1]
    if kind in ("STL", "PLY"):
        return mutated_bytes(content)
    return mutated_texts(content.decode(), WORDS).map(lambda text: text.encode("utf-8", "surrogatepass"))


@pytest.mark.parametrize("kind", GOOD)
def test_a_good_mesh_is_read(kind):
    assert held_against_its_values(kind, GOOD[kind][1])


@pytest.mark.parametrize("kind", GOOD)
@mutations(FEW)
@given(st.data())
def test_mutated_meshes(kind, data):
    held_against_its_values(kind, data.draw(damaged(kind)))


@pytest.mark.slow
@pytest.mark.parametrize("kind", GOOD)
@mutations(MANY)
@given(st.data())
def test_many_mutated_meshes(kind, data):
    held_against_its_values(kind, data.draw(damaged(kind)))
