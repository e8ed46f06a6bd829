"""Where a test's blocks stand at its start: by the survey first, then by the markers' first places."""

import numpy as np
import pytest
from resting_stack import STRUCTURE, resting_stack, write_campaign

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.initial_poses import initial_pose_lines, initial_poses, placed
from blockshake.measurement.campaigns.recorded_test import structure_at_start
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.measurement.sensors.markers import marker_position

PLACES = np.array([[0.0, 0.0, 0.0], [0.02, -0.004, 0.035], [0.021, 0.0, 0.03], [0.019, 0.0, 0.036]])


def _test(places=PLACES, survey=True, markers=True, slab=(0.0, 0.0, 0.0), bodies=slice(None)):
    """A test of the stack with its blocks at some places, seen from a frame that is ``slab`` off the structure's."""
    test = resting_stack()
    stands = load_structure(STRUCTURE, placed(STRUCTURE, places))
    if markers:
        test["marker_initial_position"][:] = (
            marker_position(STRUCTURE, stands.position, stands.orientation) + slab
        )
    else:
        test = test.drop_vars("marker_initial_position")
    if survey:
        offset, turn = np.zeros((4, 3)), np.zeros((4, 3))
        offset[:, :2], turn[:, 2] = places[:, :2], places[:, 2]
        test = test.assign_coords(body=STRUCTURE.body_names)
        test["initial_offset"], test["initial_rotation"] = (
            (("body", "axis"), offset + slab),
            (("body", "axis"), turn),
        )
        test = test.isel(body=bodies)
    return test


def _read(folder, test, role="fit"):
    return load_test(load_campaign(write_campaign(folder, test, role=role)), "t1")


def _refused(folder, test, words):
    with pytest.raises(InputError, match=words) as error:
        _read(folder, test)
    assert "\n" not in str(error.value)
    assert "t1.nc" in str(error.value)


MEASURED = {
    "survey": {"markers": False},
    "markers": {"survey": False},
    "both": {},
    "another frame": {"slab": (0.03, -0.02, 0.01)},
    "a survey of some": {"bodies": [0, 2]},
    "a survey in another order": {"bodies": [3, 1, 0, 2]},
}


@pytest.mark.parametrize("what", MEASURED)
def test_blocks_start_where_they_were_found(what, tmp_path):
    test = _read(tmp_path, _test(**MEASURED[what]))
    np.testing.assert_allclose(test["starting_place"], PLACES, atol=1e-9)
    stands, wanted = initial_poses(STRUCTURE, test), load_structure(STRUCTURE, placed(STRUCTURE, PLACES))
    np.testing.assert_allclose(stands.position, wanted.position, atol=1e-9)
    np.testing.assert_allclose(stands.orientation, wanted.orientation, atol=1e-9)
    # what is varied in it later keeps its places
    again = stands.with_parameters({"materials.concrete.density": 2300.0})
    np.testing.assert_array_equal(again.position, stands.position)
    (line,) = initial_pose_lines(test)
    assert "block-1 20.4 mm and 35 mrad" in line
    assert any(line in one for one in campaign_lines(tmp_path))


NOTHING = {
    "nothing surveyed": {"survey": False, "markers": False},
    "zero": {"places": np.zeros((4, 3))},
    "put back": {"places": np.array([[0.0, 0.0, 0.0]] + [[9e-4, -9e-4, 9e-4]] * 3)},
    "markers mounted by hand": {
        "places": np.array([[0.0, 0.0, 0.0]] + [[4e-3, -4e-3, 9e-3]] * 3),
        "survey": False,
    },
}


@pytest.mark.parametrize("what", NOTHING)
def test_blocks_that_were_put_back_start_as_in_the_structure_file(what, tmp_path):
    test = _read(tmp_path, _test(**NOTHING[what]))
    assert "starting_place" not in test
    assert initial_poses(STRUCTURE, test) is STRUCTURE
    assert initial_pose_lines(test) == []


def test_the_survey_counts_beside_markers_that_are_mounted_elsewhere(tmp_path):
    test = _test()
    carried = [name for name in map(str, test["marker"].values) if name.startswith("block-1")]
    test["marker_initial_position"].loc[{"marker": carried, "axis": "x"}] += 4e-3
    np.testing.assert_allclose(_read(tmp_path, test)["starting_place"], PLACES, atol=1e-9)


def test_one_marker_at_a_wrong_place_moves_no_block(tmp_path):
    test = _test(places=np.zeros((4, 3)), survey=False)
    test["marker_initial_position"].loc[{"marker": "block-1-face", "axis": "x"}] += 0.05
    assert "starting_place" not in _read(tmp_path, test)


def test_a_survey_that_contradicts_the_markers_is_refused(tmp_path):
    test = _test()
    test["initial_offset"].loc[{"body": "block-2", "axis": "x"}] += 8e-3
    _refused(
        tmp_path,
        test,
        "initial_offset.block-2: expected the place of its marker_initial_position, which is 8 mm along x off",
    )
    test = _test()
    test["initial_rotation"].loc[{"body": "block-2", "axis": "z"}] += 0.02
    _refused(tmp_path, test, "initial_rotation.block-2: .* which is 20 mrad off")


def test_a_block_that_is_higher_or_tilted_is_refused(tmp_path):
    for name, axis, words in (
        ("initial_offset", "z", "12 mm along z"),
        ("initial_rotation", "y", "12 mrad about y"),
    ):
        test = _test(markers=False)
        test[name].loc[{"body": "block-3", "axis": axis}] = 0.012
        _refused(
            tmp_path,
            test,
            f"{name}.block-3: expected a block as high and upright as in the structure file, not {words} off",
        )


def test_blocks_that_no_longer_bear_on_each_other_are_refused(tmp_path):
    apart = np.array([[0.0] * 3, [0.9, 0.0, 0.0], [0.0] * 3, [0.0] * 3])
    _refused(
        tmp_path,
        _test(apart, markers=False),
        "initial_offset: expected the joints of the structure file; block-1 and block-2 touch in one of both alone",
    )


def test_a_sealed_test_tells_its_start_without_its_readings(tmp_path):
    test = _test()
    test["marker_displacement"][:] = np.inf  # whoever looks at them is refused
    campaign = load_campaign(write_campaign(tmp_path, test, role="sealed"))
    stands = structure_at_start(tmp_path / "t1.nc", STRUCTURE)
    np.testing.assert_allclose(stands.position[1:, 0], PLACES[1:, 0], atol=1e-9)
    with pytest.raises(InputError, match="finite readings"):
        load_test(campaign, "t1")


def test_blocks_stand_where_they_are_put_and_the_slab_stays():
    plain = load_structure("configuration-1")
    places = np.zeros((4, 3))
    places[:] = [0.01, -0.02, 0.03]
    moved = load_structure("configuration-1", placed(plain, places))
    np.testing.assert_allclose(moved.position[1:] - plain.position[1:], [[0.01, -0.02, 0.0]] * 3, atol=1e-15)
    np.testing.assert_array_equal(moved.position[0], plain.position[0])
    # a rotation about z by an angle: Diebel (2006), quaternion (cos(a/2), 0, 0, sin(a/2))
    np.testing.assert_allclose(
        moved.orientation[1:], [[np.cos(0.015), 0.0, 0.0, np.sin(0.015)]] * 3, atol=1e-15
    )


def test_no_displacement_gives_the_structure_itself():
    plain = load_structure("configuration-2")
    same = load_structure("configuration-2", placed(plain, np.zeros((5, 3))))
    np.testing.assert_array_equal(same.position, plain.position)
    np.testing.assert_array_equal(same.orientation, plain.orientation)
