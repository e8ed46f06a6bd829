"""An entry with an array is a column, a row or a wall whose blocks touch, whatever their size."""

import numpy as np
import pytest

import blockshake
from blockshake.errors import InputError

SIZE = np.array([0.4, 0.2, 0.3])


def wall(make_mapping, array, **entry):
    body = {"name": "stone", "shape": "stone", "on": "slab", "array": array, **entry}
    return make_mapping([body], shapes={"stone": {"box": SIZE.tolist()}})


def test_a_column_is_one_block_on_the_other(make_mapping):
    structure = blockshake.load_structure(wall(make_mapping, {"counts": [1, 1, 4]}, offset=[0.1, 0.0, 0.0]))
    assert structure.body_names == ["slab", "stone-1", "stone-2", "stone-3", "stone-4"]
    heights = SIZE[2] * (np.arange(4) + 0.5)
    np.testing.assert_allclose(
        structure.centroid[1:], np.column_stack([[0.1] * 4, [0.0] * 4, heights]), atol=1e-14
    )
    np.testing.assert_array_equal(np.argwhere(np.triu(structure.touching)), [[0, 1], [1, 2], [2, 3], [3, 4]])


def test_a_running_bond_lies_by_halves_on_the_course_below(make_mapping):
    array = {"counts": [3, 1, 2], "bond": 0.5, "gap": 0.002}
    structure = blockshake.load_structure(wall(make_mapping, array))
    x, step = structure.centroid[1:, 0], SIZE[0] + 0.002
    np.testing.assert_allclose(x[:3], step * (np.arange(3) - 1.25), atol=1e-14)
    np.testing.assert_allclose(x[3:], step * (np.arange(3) - 0.75), atol=1e-14)
    assert structure.touching[1:4, 4:].astype(int).tolist() == [[1, 0, 0], [1, 1, 0], [0, 1, 1]]
    assert not structure.touching[1, 2]


def test_copies_of_a_course_touch_without_a_gap_and_follow_a_drawn_length(make_mapping):
    mapping = wall(make_mapping, {"counts": [2, 2, 1]})
    for length in (0.4, 0.5):
        structure = blockshake.load_structure(mapping, {"shapes.stone.box.x": length})
        np.testing.assert_allclose(structure.centroid[1:, 0], [-length / 2, length / 2] * 2, atol=1e-14)
        np.testing.assert_allclose(structure.centroid[1:, 1], [-0.1, -0.1, 0.1, 0.1], atol=1e-14)
        assert structure.touching[1, 2]
        assert structure.touching[1, 3]
        assert structure.with_parameters({"shapes.stone.box.x": 0.6}).touching[1, 2]


def test_a_copy_has_parameters_of_its_own(make_mapping):
    mapping = wall(make_mapping, {"counts": [1, 1, 3]}, density=2000.0)
    structure = blockshake.load_structure(mapping, {"bodies.stone-2.density": 4000.0})
    assert structure.mass[1:] / structure.mass[1] == pytest.approx([1.0, 2.0, 1.0])


@pytest.mark.parametrize(
    ("array", "entry", "line"),
    [
        ({"counts": [0, 1, 1]}, {}, r"bodies\.stone\.array\.counts"),
        ({"counts": [1, 1]}, {}, r"bodies\.stone\.array\.counts"),
        ({"counts": [1, 1, 2], "bond": 1.5}, {}, r"bodies\.stone\.array\.bond"),
        ({"counts": [1, 1, 2], "gap": -0.1}, {}, r"bodies\.stone\.array\.gap"),
        ({"counts": [1, 1, 2], "rows": 2}, {}, r"array\.rows: unknown key"),
        (
            {"counts": [1, 1, 2]},
            {"on": None, "position": [0, 0, 1]},
            "expected no array of a body with a position",
        ),
        (None, {}, r"bodies\.stone\.array"),
    ],
)
def test_a_wrong_array_is_refused(make_mapping, array, entry, line):
    with pytest.raises(InputError, match=line):
        blockshake.load_structure(wall(make_mapping, array, **entry))
