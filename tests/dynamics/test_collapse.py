import numpy as np

from blockshake.dynamics.collapse import collapse_limits, find_collapsed
from blockshake.dynamics.system import assemble_bodies
from blockshake.geometry.structure import load_structure


def lean(state, body, angle, axis):
    state.orientation[body] = [np.cos(0.5 * angle), *(np.sin(0.5 * angle) * np.array(axis, dtype=float))]


def test_only_free_bodies_that_touch_are_watched():
    supported, drop_limit = collapse_limits(load_structure("configuration-1"))
    assert supported.tolist() == [False, True, True, True]
    np.testing.assert_allclose(drop_limit, [0.1, 0.4, 0.4, 0.4])
    lifted = load_structure("configuration-1", {"bodies.block-3.position": [0.0, 0.0, 4.5]})
    assert collapse_limits(lifted)[0].tolist() == [False, True, True, False]


def test_tilt_beyond_45_degrees_is_collapse_and_yaw_is_none():
    structure = load_structure("configuration-1")
    limits = collapse_limits(structure)
    bodies, state, _ = assemble_bodies(structure)
    assert find_collapsed(bodies, state, *limits) == -1
    lean(state, 2, np.pi / 2, [0, 0, 1])
    assert find_collapsed(bodies, state, *limits) == -1
    lean(state, 2, np.radians(44.0), [0, 1, 0])
    assert find_collapsed(bodies, state, *limits) == -1
    lean(state, 2, np.radians(46.0), [1, 0, 0])
    assert find_collapsed(bodies, state, *limits) == 2


def test_drop_counts_from_the_moving_slab():
    structure = load_structure("configuration-1")
    limits = collapse_limits(structure)
    bodies, state, _ = assemble_bodies(structure)
    state.position[:, 2] -= 1.0
    assert find_collapsed(bodies, state, *limits) == -1
    state.position[3, 2] -= 0.41
    assert find_collapsed(bodies, state, *limits) == 3
