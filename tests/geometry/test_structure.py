import copy
import time

import numpy as np
import pytest
import trimesh
import yaml

from blockshake.errors import InputError
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.geometry.structure_file import dotted_values, replace_into

# kg; a box less its chamfers, by inclusion and exclusion: L W H - 2 c^2 (L + W + H) + 6 c^3
BLOCK_MASS = 2400.0 * (0.8 * 2.4 * 1.6 - 2.0 * 0.02**2 * (0.8 + 2.4 + 1.6) + 6.0 * 0.02**3)
BEAM_MASS = 2.4 * 0.2 * 0.2 * 7700.0
HEIGHTS = {1: 4.8, 2: 6.4, 3: 7.2, 4: 7.4}  # m; Zhou et al. (2023), the four configurations
N_BLOCKS = {1: 3, 2: 4, 3: 9, 4: 9}


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_the_papers_four_configurations(number):
    structure = load_structure(f"configuration-{number}")
    top = max(
        structure.position[body, 2] + structure.solid(body).vertices[:, 2].max()
        for body in range(len(structure.mass))
    )
    assert top == pytest.approx(HEIGHTS[number], abs=1e-12)
    free = structure.mass[~structure.driven]
    assert len(free) == N_BLOCKS[number] + 4 * (number == 4)
    np.testing.assert_allclose(np.sort(free)[-N_BLOCKS[number] :], BLOCK_MASS, rtol=1e-12)
    if number == 4:
        np.testing.assert_allclose(np.sort(free)[:4], BEAM_MASS, rtol=1e-12)
    # every free body stands on something
    assert structure.touching[~structure.driven].any(axis=1).all()


def test_the_joints_of_configuration_3():
    structure = load_structure("configuration-3")
    names = structure.body_names
    touching = {tuple(sorted((names[a], names[b]))) for a, b in np.argwhere(structure.touching)}
    walls = {(f"wall-{w}-{i}", f"wall-{w}-{i + 1}") for w in "ab" for i in (1, 2, 3)}
    assert touching == walls | {("slab", f"wall-{w}-1") for w in "ab"} | {
        ("top", f"wall-{w}-4") for w in "ab"
    }


@pytest.fixture
def mapping(make_mapping):
    return make_mapping(
        [
            {"name": "lower", "shape": "block", "position": [0.0, 0.0, 0.8]},
            {"name": "upper", "shape": "block", "position": [0.0, 0.0, 2.4]},
        ],
        markers=[{"name": "face", "body": "lower", "position": [0.4, 0.0, 0.0]}],
    )


def _set(mapping, path, value):
    *way, last = path
    for part in way:
        mapping = mapping[part]
    mapping[last] = value


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("colour",), "red", "colour: unknown key"),
        (("bodies", 1, "colour"), 1, "bodies.lower.colour: unknown key"),
        # what a program of YAML 1.1 makes of on
        (("bodies", 1, "true"), "slab", "bodies.lower.true: unknown key; other programs read an on without quotes as"),
        (("bodies", 1), {"name": "lower", "material": "stone", "position": [0, 0, 1]},
         "bodies.lower.shape: missing key"),
        (("bodies", 2, "position"), [0.0, 0.0, 2.395],
         "bodies.upper.position: overlaps lower by 5 mm; expected at most 1 mm"),
        (("shapes", "block", "mesh"), "a.stl",
         "shapes.block: expected either box (three edge lengths), cylinder or mesh (a file)"),
        (("materials", "stone", "density"), "heavy", "materials.stone.density: "),
        (("materials", "stone", "density"), float("nan"), "materials.stone.density: "),
        (("materials", "stone", "density"), "2400",
         "materials.stone.density: input should be a valid number, not '2400'"),
        (("materials", "stone", "density"), True, "materials.stone.density: input should be a valid number, not True"),
        (("bodies", 1, "position"), [0.0, "0", 0.8],
         "bodies.lower.position.1: input should be a valid number, not '0'"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_that_names_the_key(mapping, path, value, message):
    """Each fault alone, in a structure that loads without it; other values of keys: tests/own_files/wrong_keys.py."""
    build_structure(copy.deepcopy(mapping), "s.yaml", ".")
    _set(mapping, path, value)
    with pytest.raises(InputError) as error:
        build_structure(mapping, "s.yaml", ".")
    assert str(error.value).startswith(f"s.yaml: {message}")
    assert "\n" not in str(error.value)


def test_a_whole_number_is_a_number(mapping):
    mapping["materials"]["stone"]["density"] = 2400
    assert build_structure(mapping, "s.yaml", ".").mass[1] == pytest.approx(BLOCK_MASS, rel=1e-12)


def test_two_driven_bodies_must_not_overlap_either(mapping):
    """Driven bodies do not count as touching, for no force acts between them; an overlap beyond 1 mm is refused."""
    slab = {"name": "second", "shape": "slab", "material": "stone", "driven": True}
    mapping["bodies"].append({**slab, "position": [3.0, 0.0, -0.1]})
    structure = build_structure(mapping, "s.yaml", ".")
    assert not structure.touching[0, 3]
    mapping["bodies"][3]["position"] = [2.998, 0.0, -0.1]
    with pytest.raises(InputError, match=r"s.yaml: bodies.second.position: overlaps slab by 2 mm"):
        build_structure(mapping, "s.yaml", ".")


def test_friction_is_that_of_each_pairs_materials(mapping):
    mapping["materials"]["rock"] = dict(mapping["materials"]["stone"])
    mapping["friction"] += [{"pair": ["rock", "stone"], "coefficient": 0.4}]
    mapping["bodies"][2]["material"] = "rock"
    slab = {"name": "far", "shape": "slab", "material": "stone", "driven": True}
    mapping["bodies"].append({**slab, "position": [9.0, 0.0, -0.1]})
    # slab, lower, upper, far; a single rock needs no coefficient with itself, nor do driven bodies
    nan = np.nan
    expected = [[nan, 0.5, 0.4, nan], [0.5, nan, 0.4, 0.5], [0.4, 0.4, nan, 0.4], [nan, 0.5, 0.4, nan]]
    np.testing.assert_array_equal(build_structure(mapping, "s.yaml", ".").friction, expected)
    mapping["bodies"][1]["material"] = "rock"
    with pytest.raises(InputError, match=r"s.yaml: friction.rock.rock: missing"):
        build_structure(mapping, "s.yaml", ".")


def test_a_wall_of_two_thousand_blocks_loads_in_seconds(make_mapping):
    """Every block stands on two, and has its neighbours in the row."""
    columns, rows = 50, 40
    blocks = [
        {
            "name": f"block-{row}-{column}",
            "shape": "block",
            "position": [0.0, 2.4 * (column + 0.5 * (row % 2)), 0.8 + 1.6 * row],
        }
        for row in range(rows)
        for column in range(columns)
    ]
    mapping = make_mapping(blocks, shapes={"slab": {"box": [3.0, 300.0, 0.2]}})
    start = time.process_time()
    structure = build_structure(mapping, "s.yaml", ".")
    assert time.process_time() - start < 3.0
    in_rows, between_rows = rows * (columns - 1), (rows - 1) * (2 * columns - 1)
    assert structure.touching.sum() == 2 * (columns + in_rows + between_rows)


def test_an_overlap_below_a_millimetre_is_an_initial_penetration(mapping):
    mapping["bodies"][2]["position"] = [0.0, 0.0, 2.3991]
    assert build_structure(mapping, "s.yaml", ".").touching[1, 2]


@pytest.mark.parametrize(("gap", "touching"), [(0.9e-4, True), (1.1e-4, False)])
def test_bodies_touch_within_a_tenth_of_a_millimetre(mapping, gap, touching):
    """Bodies within 0.1 mm are a touching pair (docs/guide/contracts.md, start of a run)."""
    mapping["bodies"][2]["position"] = [0.0, 0.0, 2.4 + gap]
    assert build_structure(mapping, "s.yaml", ".").touching[1, 2] == touching


def test_a_closed_mesh_is_recentred_and_an_open_one_refused(mapping, tmp_path):
    cube = trimesh.creation.box([0.8, 2.4, 1.6])
    cube.apply_translation([5.0, 6.0, 7.0])
    cube.export(tmp_path / "closed.stl")
    cube.update_faces(np.arange(11))
    cube.export(tmp_path / "open.stl")
    mapping["shapes"]["block"] = {"mesh": "closed.stl"}
    structure = build_structure(mapping, "s.yaml", tmp_path)
    # binary STL holds single precision
    np.testing.assert_allclose(np.abs(structure.solids["block"].vertices), [[0.4, 1.2, 0.8]] * 8, atol=1e-6)
    assert structure.mass[1] == pytest.approx(0.8 * 2.4 * 1.6 * 2400.0, rel=1e-5)
    mapping["shapes"]["block"] = {"mesh": "open.stl"}
    with pytest.raises(InputError, match=r"s.yaml: shapes.block.mesh: expected a closed surface"):
        build_structure(mapping, "s.yaml", tmp_path)
    mapping["shapes"]["block"] = {"mesh": "none.stl"}
    with pytest.raises(InputError, match=r"s.yaml: shapes.block.mesh: expected a readable mesh file"):
        build_structure(mapping, "s.yaml", tmp_path)


def test_a_nearly_unit_quaternion_is_made_one(mapping):
    mapping["bodies"][2]["orientation"] = [1.0005, 0.0, 0.0, 0.0]
    structure = build_structure(mapping, "s.yaml", ".")
    np.testing.assert_allclose(structure.orientation[2], [1.0, 0.0, 0.0, 0.0], atol=1e-15)


@pytest.fixture
def path(mapping, tmp_path):
    path = tmp_path / "s.yaml"
    mapping["materials"]["rock"] = dict(mapping["materials"]["stone"])
    mapping["friction"].append({"pair": ["stone", "rock"], "coefficient": 0.4})
    mapping["friction"].append({"pair": ["rock", "rock"], "coefficient": 0.3})
    mapping["bodies"][2]["material"] = "rock"
    path.write_text(yaml.safe_dump(mapping))
    return path


@pytest.mark.parametrize("key", ["friction.stone.rock", "friction.rock.stone"])
def test_a_friction_pair_is_set_in_either_order(path, key):
    structure = load_structure(path, {key: 0.66})
    assert structure.friction[1, 2] == structure.friction[2, 1] == 0.66
    assert structure.friction[0, 1] == 0.5
    assert np.isnan(structure.friction[1, 1])


def test_dotted_parameters_reach_their_places(path):
    plain = load_structure(path)
    structure = load_structure(
        path,
        {
            "materials.stone.density": 1200.0,
            "bodies.upper.density": 4800.0,
            "restitution": 0.7,
            "gravity": [0, 0, -1],
        },
    )
    np.testing.assert_allclose(structure.mass / plain.mass, [0.5, 0.5, 2.0], rtol=1e-12)
    np.testing.assert_allclose(structure.inertia[2], 2.0 * plain.inertia[2], rtol=1e-12)
    assert structure.file.restitution == 0.7
    assert structure.file.gravity == (0.0, 0.0, -1.0)


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("materials.stone.densty", "materials.stone.densty: unknown key"),
        ("materials.steel.density", "materials.steel.density: expected a parameter of this structure"),
        ("bodies.nobody.density", "bodies.nobody.density: expected a parameter of this structure"),
        (
            "friction.stone.air",
            "friction.stone.air: expected friction.MATERIAL.MATERIAL or",
        ),
        ("friction.stone", "friction.stone: expected friction.MATERIAL.MATERIAL"),
        ("bodies.slab.position.0", "bodies.slab.position.0: expected a parameter of this structure"),
        ("bodies.slab.position.0.x", "bodies.slab.position.0.x: expected a parameter of this structure"),
    ],
)
def test_a_parameter_that_the_structure_lacks_is_an_error(path, key, message):
    with pytest.raises(InputError) as error:
        load_structure(path, {key: 1.0})
    assert str(error.value).startswith(f"{path}: {message}")


@pytest.mark.parametrize(
    "key",
    [
        "friction.concrete.foundation",
        "friction.foundation.concrete",
        "friction.foundation.concrete.coefficient",
        "joints.block-2.block-1.friction_factor",
        "bodies.block-2.position.z",
        "shapes.block.box.y",
        "materials.concrete.density",
        "restitution",
    ],
)
def test_a_wrong_value_names_the_key_as_it_was_given(key):
    with pytest.raises(InputError) as error:
        load_structure("configuration-1", {key: "abc"})
    assert error.value.key == key
    assert error.value.expected.endswith("valid number, not 'abc'")


def test_an_unknown_name_lists_the_shipped_ones():
    with pytest.raises(
        InputError, match="configuration-9: expected a structure file or one of configuration-1, "
    ):
        load_structure("configuration-9")


CHANGES = {
    "friction.foundation.concrete": 0.6,
    "materials.concrete.density": 2350,
    "bodies.block-2.position": [0.01, 0.0, 2.4],
    "bodies.block-2.mass_offset": [0.02, 0.0, 0.0],
    "joints.block-1.block-2.friction_factor": 0.5,
    "shapes.block.chamfer": 0.03,
    "stoppers": [
        {"body": "block-4", "position": [0.4, 0.0, 0.8], "axis": "+x", "gap": 0.01, "stiffness": 1e6}
    ],
}


def test_a_loaded_structure_with_parameters_is_the_one_loaded_with_them(monkeypatch):
    """One change after the other, from memory, to the bit; the first structure stays as it was."""
    plain = load_structure("configuration-2")
    expected = load_structure("configuration-2", CHANGES)
    content = plain.file.model_dump_json()
    monkeypatch.setattr("blockshake.geometry.structure.load_yaml", None)
    changed = plain
    for key, value in CHANGES.items():
        changed = load_structure(changed, {key: value})
    assert changed.file == expected.file
    assert plain.file.model_dump_json() == content
    assert load_structure(plain) is plain
    for name in ("mass", "inertia", "position", "orientation", "friction", "touching"):
        np.testing.assert_array_equal(getattr(changed, name), getattr(expected, name))
    for name, solid in expected.solids.items():
        np.testing.assert_array_equal(changed.solids[name].vertices, solid.vertices)
    assert changed.solids["slab"] is plain.solids["slab"]
    with pytest.raises(InputError, match=r"configuration-2: friction\.wood\.wood: expected"):
        plain.with_parameters({"friction.wood.wood": 0.5})


def test_every_value_is_set_by_the_dotted_name_that_it_is_listed_by():
    structure = load_structure("configuration-3", {"joints.wall-a-1.wall-a-2.compliance": 1e-10})
    mapping = structure.file.model_dump(mode="json")
    values = dotted_values(mapping)
    assert values["bodies.wall-a-1.mass_offset.x"] == 0.0
    assert values["joints.wall-a-1.wall-a-2.compliance"] == 1e-10
    numbers = [name for name, value in values.items() if isinstance(value, float)]
    for name in numbers:
        replace_into(mapping, name, 7.0, "")
    assert {dotted_values(mapping)[name] for name in numbers} == {7.0}
    assert {name: value for name, value in dotted_values(mapping).items() if name not in numbers} == {
        name: value for name, value in values.items() if name not in numbers
    }


def test_content_is_that_of_the_blocks_whatever_they_are_called():
    structure = load_structure("configuration-1")
    named = structure.with_parameters({"name": "other", "description": "others"})
    assert named.content == structure.content
    assert structure.with_parameters({"shapes.block.chamfer": 0.021}).content != structure.content
