import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.measurement.sensors.markers import driven_marker, marker_position

ROUNDING = 1e-12  # m, of a few sums of metres


@pytest.fixture
def two_bodies(make_structure):
    """Structure of a block on a slab with markers."""
    block = {"name": "block", "shape": "sharp", "position": [0.0, 0.0, 0.8]}
    return lambda markers: make_structure([block], markers=markers)


BOTH = [
    {"name": "face", "body": "block", "position": [0.4, 0.0, 0.2]},
    {"name": "slab-face", "body": "slab", "position": [1.5, 0.0, 0.0]},
]


def _poses(angles, shifts):
    """Block leaning about y by angles, slab and block shifted along x."""
    position = np.zeros((len(angles), 2, 3))
    position[:, 0, 2], position[:, 1, 2] = -0.1, 0.8
    position[:, :, 0] += np.asarray(shifts)[:, None]
    orientation = np.zeros((len(angles), 2, 4))
    orientation[:, :, 0] = 1.0
    orientation[:, 1, 0], orientation[:, 1, 2] = np.cos(np.divide(angles, 2)), np.sin(np.divide(angles, 2))
    return position, orientation


def test_marker_moves_with_the_mass_centre_and_the_arm(two_bodies):
    angle = 0.3
    position, orientation = _poses([0.0, 0.0, angle], [0.0, 0.02, 0.02])
    places = marker_position(two_bodies(BOTH), position, orientation)
    assert places.shape == (3, 2, 3)
    moved = places - places[0]
    np.testing.assert_allclose(moved[1], [[0.02, 0.0, 0.0]] * 2, atol=ROUNDING)
    # positive about y leans the top to +x: x = 0.4 cos + 0.2 sin, z = -0.4 sin + 0.2 cos
    expected = [
        0.02 + 0.4 * np.cos(angle) + 0.2 * np.sin(angle) - 0.4,
        0.0,
        -0.4 * np.sin(angle) + 0.2 * np.cos(angle) - 0.2,
    ]
    np.testing.assert_allclose(moved[2, 0], expected, atol=ROUNDING)
    np.testing.assert_allclose(moved[2, 1], [0.02, 0.0, 0.0], atol=ROUNDING)


def test_a_tilted_block_tilts_its_markers(two_bodies):
    position, orientation = _poses([0.1, 0.1], [0.0, 0.0])
    placed = marker_position(two_bodies(BOTH), position[0], orientation[0])
    assert placed[0, 2] == pytest.approx(0.8 - 0.4 * np.sin(0.1) + 0.2 * np.cos(0.1), abs=ROUNDING)


def test_nan_after_an_abort_stays(two_bodies):
    position, orientation = _poses([0.0, 0.1, 0.2], [0.0, 0.0, 0.0])
    position[2], orientation[2] = np.nan, np.nan
    moved = marker_position(two_bodies(BOTH), position, orientation)
    assert np.isnan(moved[2]).all()
    assert np.isfinite(moved[:2]).all()


def test_no_markers_give_no_columns(two_bodies):
    position, orientation = _poses([0.0, 0.1], [0.0, 0.0])
    assert marker_position(two_bodies([]), position, orientation).shape == (2, 0, 3)


def test_the_slabs_marker_is_the_first_on_a_driven_body(two_bodies):
    assert driven_marker(two_bodies(BOTH)) == "slab-face"
    with pytest.raises(InputError, match="marker on a driven body"):
        driven_marker(two_bodies(BOTH[:1]))
