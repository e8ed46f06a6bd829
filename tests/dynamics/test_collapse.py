import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.dynamics.collapse import collapse_limits, find_collapsed
from blockshake.dynamics.system import assemble_bodies


@pytest.fixture
def stack(make_structure):
    """Two blocks on the slab, the upper one given lying on its side, and one in the air."""
    side = [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]
    structure = make_structure(
        [
            {"name": "lower", "shape": "block", "position": [0.0, 0.0, 0.8]},
            {"name": "upper", "shape": "block", "position": [0.0, 0.0, 2.0], "orientation": side},
            {"name": "air", "shape": "block", "position": [0.0, 0.0, 5.0]},
        ]
    )
    bodies, state, _ = assemble_bodies(structure)
    return bodies, state, collapse_limits(structure)


def _turn(state, body, axis, degrees):
    turn = Rotation.from_rotvec(np.radians(degrees) * np.asarray(axis, float))
    now = Rotation.from_quat(state.orientation[body], scalar_first=True)
    state.orientation[body] = (turn * now).as_quat(scalar_first=True)


def test_bodies_that_stand_on_something_are_watched(stack):
    _, _, (supported, drop_limit) = stack
    np.testing.assert_array_equal(supported, [False, True, True, False])
    # half the smallest extent: 0.8 m
    np.testing.assert_allclose(drop_limit[1:], 0.4, rtol=1e-12)


def test_the_start_is_no_collapse(stack):
    bodies, state, limits = stack
    assert find_collapsed(bodies, state, *limits) == -1


@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 0, 0), (-0.6, 0.8, 0)])
def test_a_lean_beyond_45_degrees_is_one(stack, body, axis):
    bodies, state, limits = stack
    _turn(state, body, axis, 44.9)
    assert find_collapsed(bodies, state, *limits) == -1
    _turn(state, body, axis, 0.2)
    assert find_collapsed(bodies, state, *limits) == body


def test_turning_about_the_vertical_is_none(stack):
    bodies, state, limits = stack
    _turn(state, 1, (0, 0, 1), 90.0)
    _turn(state, 2, (0, 0, 1), 170.0)
    assert find_collapsed(bodies, state, *limits) == -1


def test_a_drop_beyond_the_limit_with_respect_to_the_slab_is_one(stack):
    bodies, state, limits = stack
    state.position[2, 2] -= 0.399
    assert find_collapsed(bodies, state, *limits) == -1
    state.position[2, 2] -= 0.002
    assert find_collapsed(bodies, state, *limits) == 2
    # the slab went down as well
    state.position[0, 2] -= 0.01
    assert find_collapsed(bodies, state, *limits) == -1


def test_a_body_in_the_air_may_fall_and_turn(stack):
    bodies, state, limits = stack
    state.position[3, 2] -= 3.0
    _turn(state, 3, (0, 1, 0), 90.0)
    assert find_collapsed(bodies, state, *limits) == -1
