"""Points far off their bodies: refused beyond three longest edges, remarked beyond half of one."""

import copy

import pytest

from blockshake.errors import InputError
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.geometry.structure_file import point_remarks

BUILT = load_structure("configuration-1")  # blocks of 0.8 x 2.4 x 1.6 m
KINDS = {
    "markers": {"name": "far", "body": "block-1"},
    "accelerometers": {"name": "far", "body": "block-1", "axes": ["x"]},
    "stoppers": {"body": "block-1", "axis": "+x", "gap": 0.05, "stiffness": 1e7},
    "external_forces": {"body": "block-1", "amplitude": 1e3},
}


def _with(kind, entry, position):
    mapping = copy.deepcopy(BUILT.file.model_dump(mode="json"))
    mapping[kind] = [*mapping[kind], {**entry, "position": position}]
    return build_structure(mapping, "mine.yaml", BUILT.folder)


@pytest.mark.parametrize("kind", KINDS)
def test_a_point_25_m_off_its_block_is_refused(kind):
    """Outside of the box by 24.6 m along x."""
    with pytest.raises(InputError, match=rf"mine\.yaml: {kind}\.\w+\.position: .*2\.4 m.*24\.6 m off"):
        _with(kind, KINDS[kind], [25.0, 0.0, 0.0])


@pytest.mark.parametrize("kind", KINDS)
def test_a_mast_is_allowed_and_a_long_one_remarked(kind):
    """Half of the longest edge is 1.2 m, above the top at 0.8 m."""
    assert point_remarks(_with(kind, KINDS[kind], [0.0, 0.0, 1.9])) == []
    (remark,) = point_remarks(_with(kind, KINDS[kind], [0.0, 0.0, 2.1]))
    assert "lies 1.3 m off block-1, whose longest edge is 2.4 m" in remark


def test_a_wire_may_leave_a_high_frame_but_not_another_place():
    """The slab is 3 m long; a frame of 8 m is remarked, an anchor 30 m away refused."""
    wire = {
        "name": "wire", "body": "block-1", "position": [-0.4, 0.0, 0.7], "reference": "slab",
        "reference_position": [-1.4, 0.0, 8.0],
    }  # fmt: skip
    mapping = copy.deepcopy(BUILT.file.model_dump(mode="json"))
    mapping["displacement_transducers"] = [wire]
    assert point_remarks(build_structure(mapping, "mine.yaml", BUILT.folder))
    wire["reference_position"] = [-30.0, 0.0, 1.6]
    with pytest.raises(InputError, match=r"wire\.reference_position"):
        build_structure(mapping, "mine.yaml", BUILT.folder)
