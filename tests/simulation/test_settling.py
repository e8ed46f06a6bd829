"""A body that moves before the ground does is reported of; one that waits for it is not."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.settling import quiet_until, settling
from blockshake.simulation.simulate import simulate

TIME = np.linspace(0.0, 1.0, 101)
B, H = 0.4, 0.8  # m, half width and half height of the sharp block


def motion(start, strength=3.0):
    return ground_motion("push", TIME, {"x": strength * (start < TIME)}, "acceleration")


def tilted(angle):
    """A sharp block turned about its right lower edge, which stays on the slab."""
    c, s = np.cos(angle), np.sin(angle)
    return {
        "name": "block", "shape": "sharp", "position": [B - B * c + H * s, 0.0, B * s + H * c],
        "orientation": [np.cos(angle / 2.0), 0.0, np.sin(angle / 2.0), 0.0],
    }  # fmt: skip


@pytest.fixture
def standing(make_structure):
    return make_structure([{"name": "block", "shape": "sharp", "position": [0.0, 0.0, H]}])


def test_the_ground_is_at_rest_until_2_percent_of_gravity(standing):
    assert quiet_until(standing, motion(0.505)) == pytest.approx(0.5)
    assert quiet_until(standing, motion(-1.0)) == 0.0
    assert quiet_until(standing, motion(0.505, strength=0.1)) == 0.0
    slow = ground_motion("pitch", TIME, {"pitch_y": 0.03 * TIME**2}, "acceleration")
    assert quiet_until(standing, slow) == pytest.approx(np.sqrt(0.002 / 0.03), abs=0.01)


@pytest.mark.parametrize(("angle", "told"), [(0.008, False), (0.02, True)])
def test_a_lean_is_told_from_a_hundredth_of_the_size_on(standing, angle, told):
    """A corner moves by the angle times its distance from the pivot, 1.79 m, over the largest extent of 2.4 m."""
    turned, position, orientation = tilted(angle), standing.position.copy(), standing.orientation.copy()
    position[1], orientation[1] = turned["position"], turned["orientation"]
    words = settling(standing, position, orientation)
    assert bool(words) == told
    if told:
        assert words.startswith("block moved by 1.5% of its size and tilted by 1.1 degrees before the ground")
    # the slab carries it along
    assert settling(standing, position + np.array([0.3, 0.0, 0.0]), orientation) == words


def test_a_run_tells_of_a_block_that_was_not_at_rest(make_structure, standing):
    assert simulate(standing, motion(0.3, 1.0), "nscd-rigid", accelerometers=False).attrs["reason"] == ""
    run = simulate(make_structure([tilted(0.05)]), motion(0.3, 1.0), "nscd-rigid", accelerometers=False)
    assert run.attrs["status"] == "completed"
    assert run.attrs["reason"].startswith("block moved by")
