"""Surfaces of mesh files: refused, or of the mass that an independent integration gives."""

import numpy as np
import pytest
import trimesh
from solid_angles import box, prism, sampled_properties, winding_numbers

from blockshake.errors import InputError
from blockshake.geometry.meshes.mesh_file import crossings, parts_of, read_mesh
from blockshake.geometry.polyhedron import mass_properties
from blockshake.geometry.structure import build_structure

L_OUTLINE = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
L_CAP = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]]
BOW_TIE = [[0, 0], [2, 2], [2, 0], [0, 1]]  # an outline that crosses itself
TURN = trimesh.transformations.rotation_matrix(0.7, [1.0, 2.0, 3.0])[:3, :3]
NATIONAL = np.array([5e5, 4e6, 100.0])  # m, of a surveyor
SPHERE = np.array(trimesh.creation.icosphere(2).triangles)


def together(*parts):
    return np.concatenate(parts)


SOLIDS = {
    "a box": box((0.8, 2.4, 1.6)) @ TURN.T,
    "an L": prism(L_OUTLINE, 1.0, L_CAP),
    "a turned L": prism(L_OUTLINE, 1.0, L_CAP) @ TURN.T,
    "a sphere": SPHERE,
    "a cavity": together(box(), box((0.5, 0.4, 0.3), (0.1, 0.0, 0.05), inwards=True)),
    "a stone in a cavity": together(box(), box((0.5,) * 3, inwards=True), box((0.2,) * 3)),
    "separate parts": together(box(), box((0.5, 0.6, 0.7), (2.0, 0.3, 0.1))),
    "parts in each other's box": together(prism(L_OUTLINE, 1.0, L_CAP), box((0.5,) * 3, (1.5, 1.5, 0.5))),
    "parts face to face": together(box(), box((0.5,) * 3, (0.75, 0.1, 0.05))),
    "a ring": np.array(trimesh.creation.torus(1.0, 0.3, major_sections=16, minor_sections=8).triangles),
}
WRONG = {
    "overlapping parts": (together(box(), box(at=(0.5, 0, 0))), "part 1 and 2 of 2 overlap"),
    "parts that overlap by 1 mm": (together(box(), box(at=(0.999, 0.2, 0.3))), "part 1 and 2 .*over 0.001 m"),
    "parts that overlap at a corner": (together(box(), box(at=(0.97, 0.97, 0.97))), "part 1 and 2 of 2 overlap"),
    "overlapping parts turned": (together(box(), box(at=(0.5, 0.3, 0.2)) @ TURN.T), "part 1 and 2 of 2 overlap"),
    "nested parts": (together(box(), box((0.5,) * 3)), "part 1 and 2 of 2 overlap or lie within"),
    "the third of three": (
        together(box(), box(at=(3, 0, 0)), box((0.2,) * 3, (3, 0, 0))), "part 2 and 3 of 3 overlap or lie within",
    ),
    "overlapping needles": (
        together(box((20.0, 0.01, 0.01)), box((20.0, 0.01, 0.01), (0.0, 0.005, 0.005))), "part 1 and 2 of 2 overlap",
    ),
    "a shell twice": (together(box(), box() + 3e-8), "part 1 and 2 of 2 overlap|does not join just two"),
    "the same shell twice": (together(box(), box()), "does not join just two"),
    "a triangle twice": (together(box(), box()[:1]), "does not join just two"),
    "a triangle and its back": (together(box(), box()[:1], box()[:1, ::-1]), "does not join just two"),
    "a missing triangle": (box()[1:], "does not join just two"),
    "a turned triangle": (together(box()[1:], box()[:1, ::-1]), "does not join just two"),
    "turned inwards": (box(inwards=True), "flat, or turned inwards"),
    "a separate part turned inwards": (
        together(box(), box((0.5,) * 3, (2, 0, 0), inwards=True)), "part 2 of 2 is turned inwards",
    ),
    "a cavity out of its wall": (
        together(box(), box((0.5,) * 3, (0.4, 0, 0), inwards=True)), "part 2 of 2 is turned inwards|crosses itself",
    ),
    "a surface that crosses itself": (prism(BOW_TIE, 1.0, [[0, 1, 2], [0, 2, 3]]), "crosses itself|turned inwards"),
    "two parts with a common edge": (together(box(), box(at=(1, 1, 0))), "does not join just two"),
    "flat": (box((1.0, 1.0, 0.0)), "flat|does not join just two"),
    "nothing": (box()[:0], "no triangles|readable"),
}  # fmt: skip


def written(folder, triangles, suffix, **how):
    """Name of a file with these triangles."""
    mesh = trimesh.Trimesh(
        triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), process=False
    )
    if suffix in (".obj", ".off", ".ply"):
        mesh.merge_vertices()
    content = mesh.export(file_type=how.pop("file_type", suffix[1:]), **how)
    (folder / f"m{suffix}").write_bytes(content if isinstance(content, bytes) else content.encode())
    return f"m{suffix}"


def read(folder, triangles, suffix=".obj", **how):
    return read_mesh(folder, written(folder, triangles, suffix, **how), "s.yaml", "shapes.a.mesh")


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_has_the_mass_of_an_independent_integration(name, tmp_path):
    triangles = SOLIDS[name]
    properties = mass_properties(*read(tmp_path, triangles))
    volume, centroid, inertia, error = sampled_properties(triangles)
    assert properties.volume == pytest.approx(volume, abs=4.0 * error)
    middle = 0.5 * (triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1)))
    share = 4.0 * error / volume  # of a sum over points, which the arms bound
    reach = np.linalg.norm(np.ptp(triangles.reshape(-1, 3), axis=0))
    np.testing.assert_allclose(
        properties.centroid + middle, centroid, rtol=0.0, atol=share * reach + 0.01 * reach
    )
    np.testing.assert_allclose(
        properties.inertia, inertia, rtol=0.0, atol=2.0 * (share + 0.01) * volume * reach**2
    )


@pytest.mark.parametrize("name", WRONG)
def test_a_surface_that_is_no_solid_is_refused(name, tmp_path):
    triangles, words = WRONG[name]
    with pytest.raises(InputError, match=rf"s.yaml: shapes.a.mesh: expected a .*({words})"):
        read(tmp_path, triangles)


@pytest.mark.parametrize(
    ("suffix", "how"),
    [
        (".stl", {}), (".stl", {"file_type": "stl_ascii"}), (".obj", {}), (".off", {}), (".ply", {}),
        (".ply", {"encoding": "ascii"}),
    ],
)  # fmt: skip
def test_every_format_gives_the_same_solid_and_the_same_refusal(suffix, how, tmp_path):
    cavity = mass_properties(*read(tmp_path, SOLIDS["a cavity"], suffix, **how))
    assert cavity.volume == pytest.approx(1.0 - 0.5 * 0.4 * 0.3, rel=1e-6)
    parts = mass_properties(*read(tmp_path, SOLIDS["separate parts"], suffix, **how))
    assert parts.volume == pytest.approx(1.0 + 0.5 * 0.6 * 0.7, rel=1e-6)
    with pytest.raises(InputError, match="part 1 and 2 of 2 overlap"):
        read(tmp_path, WRONG["overlapping parts"][0], suffix, **how)


def test_a_texture_does_not_part_a_closed_surface(tmp_path):
    """Every corner of every triangle has a place of its own in the texture, as in many scans."""
    corners = box().reshape(-1, 3)
    lines = [f"v {x} {y} {z}\nvt {n / 36} 0.5\nvn 0 0 1" for n, (x, y, z) in enumerate(corners)]
    lines += [f"f {n}/{n}/{n} {n + 1}/{n + 1}/{n + 1} {n + 2}/{n + 2}/{n + 2}" for n in range(1, 37, 3)]
    (tmp_path / "m.obj").write_text("\n".join(lines))
    vertices, faces = read_mesh(tmp_path, "m.obj", "s.yaml", "shapes.a.mesh")
    assert vertices.shape == (8, 3)
    assert mass_properties(vertices, faces).volume == pytest.approx(1.0, rel=1e-12)


def test_a_concave_polygon_is_refused_and_its_triangles_are_read(tmp_path):
    """A fan over the concave end faces of an L folds: areas of nodes would count twice, outside of the body."""
    corners = [[x, y, z] for z in (0, 1) for x, y in L_OUTLINE]
    lines = ["v {} {} {}".format(*corner) for corner in corners]
    lines += [f"f {n} {n % 6 + 1} {n % 6 + 7} {n + 6}" for n in range(1, 7)]
    caps = ["f 8 9 10 11 12 7", "f 6 5 4 3 2 1"]
    (tmp_path / "m.obj").write_text("\n".join(lines + caps))
    with pytest.raises(
        InputError, match=r"two triangles lie on each other .* is a polygon of the file concave"
    ):
        read_mesh(tmp_path, "m.obj", "s.yaml", "shapes.a.mesh")
    caps = [f"f {a + 7} {b + 7} {c + 7}\nf {c + 1} {b + 1} {a + 1}" for a, b, c in L_CAP]
    (tmp_path / "m.obj").write_text("\n".join(lines + caps))
    assert mass_properties(*read_mesh(tmp_path, "m.obj", "s", "k")).volume == pytest.approx(3.0, rel=1e-12)


def test_a_mesh_in_national_coordinates_keeps_its_digits_or_is_refused(tmp_path):
    """A stone at 500 km east, 4000 km north: 32-bit coordinates there are 0.25 m apart."""
    stone = 0.4 * SPHERE @ TURN.T * [1.0, 0.7, 0.5]
    here = mass_properties(*read(tmp_path, stone))
    there = mass_properties(*read(tmp_path, stone + NATIONAL + 0.123, digits=12))
    assert there.volume == pytest.approx(here.volume, rel=1e-7)
    np.testing.assert_allclose(there.inertia, here.inertia, rtol=0.0, atol=1e-7 * here.inertia.max())
    far = together(box(), box(at=(3.0, 0.0, 0.0))) + NATIONAL
    for suffix in (".stl", ".ply"):
        with pytest.raises(InputError, match=r"its 32-bit coordinates are 0.25 m apart"):
            read(tmp_path, far, suffix)
        assert len(read(tmp_path, far - NATIONAL, suffix)[1]) == 24
    assert len(read(tmp_path, far)[1]) == 24


def test_the_mass_of_a_structure_is_that_of_its_mesh(make_mapping, tmp_path):
    shapes = {"stone": {"mesh": written(tmp_path, SOLIDS["a cavity"] + [7.0, 8.0, 9.0], ".obj")}}
    mapping = make_mapping([{"name": "a", "shape": "stone", "position": [0, 0, 0.5]}], shapes=shapes)
    structure = build_structure(mapping, "s.yaml", tmp_path)
    assert structure.mass[1] == pytest.approx(2400.0 * (1.0 - 0.06), rel=1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_crossings_count_the_winding_number(axis):
    """On every ray, half-way between crossings, against the solid angles; also where the surface is no solid."""
    mesh = trimesh.Trimesh(
        together(box(), box(at=(0.5, 0.3, 0.2)) @ TURN.T).reshape(-1, 3), np.arange(72).reshape(-1, 3), process=False
    )  # fmt: skip
    mesh.merge_vertices()
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    hits = crossings(vertices, faces, axis, 13)
    sums = np.cumsum(hits.step)
    last = np.append(hits.ray[1:] != hits.ray[:-1], True)
    assert not sums[last].any()
    assert (np.diff(hits.height)[~last[:-1]] >= 0.0).all()
    middle = 0.5 * (hits.point[1:] + hits.point[:-1])[~last[:-1]]
    np.testing.assert_allclose(winding_numbers(vertices[faces], middle), sums[:-1][~last[:-1]], atol=1e-6)
    assert set(sums.tolist()) == {0, 1, 2}


def test_parts_are_numbered_in_the_order_of_the_file():
    faces = np.array([[0, 1, 2], [3, 4, 5], [5, 6, 7], [2, 8, 9], [10, 11, 12]])
    assert parts_of(faces).tolist() == [0, 1, 1, 0, 2]
