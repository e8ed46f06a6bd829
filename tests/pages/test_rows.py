import pytest

from blockshake.geometry.structure import load_structure
from blockshake.pages.rows import face_markers, top_markers


@pytest.mark.parametrize("name", ["configuration-1", "configuration-2", "configuration-3", "configuration-4"])
def test_rows_go_from_the_top_block_down_and_hold_every_block(name):
    structure = load_structure(name)
    markers = face_markers(structure)
    heights = [structure.position[structure.body_names.index(body), 2] for body in markers]
    assert heights == sorted(heights, reverse=True)
    blocks = [body.name for body in structure.file.bodies if not body.driven and body.shape != "beam"]
    assert sorted(markers) == sorted(blocks)
    assert all(marker == f"{body}-face" for body, marker in markers.items())


def test_structure_without_face_markers_takes_the_first_of_each_body(make_structure):
    structure = make_structure(
        [
            {"name": "low", "shape": "cube", "position": [0, 0, 0.5]},
            {"name": "high", "shape": "cube", "position": [0, 0, 1.5]},
        ],
        markers=[
            {"name": "a", "body": "low", "position": [0, 0, 0]},
            {"name": "b", "body": "low", "position": [0, 0.1, 0]},
            {"name": "c", "body": "high", "position": [0, 0, 0]},
            {"name": "s", "body": "slab", "position": [0, 0, 0]},
        ],
    )  # fmt: skip
    assert list(face_markers(structure).items()) == [("high", "c"), ("low", "a")]


def test_every_leaf_has_its_top_block(make_structure):
    bodies = [
        {"name": f"wall-{leaf}-{number}", "shape": "cube", "position": [x, 0, number - 0.5]}
        for leaf, x in (("a", 0.0), ("b", 1.5))
        for number in (1, 2)
    ]
    markers = [{"name": f"{one['name']}-face", "body": one["name"], "position": [0, 0, 0]} for one in bodies]
    markers = [one for one in markers if one["body"] != "wall-b-2"]
    structure = make_structure(bodies, markers=markers)
    assert top_markers(structure) == {"wall-a-2": "wall-a-2-face", "wall-b-1": "wall-b-1-face"}
