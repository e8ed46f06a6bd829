"""A wall that falls as the window ends is no wall that stands: the same run, cut before it is down and after."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.simulate import simulate

TIME = np.linspace(0.0, 1.0, 201)
AHEAD = 0.46  # s, from the end of the window to the ground


def push(strength):
    return ground_motion("push", TIME, {"x": strength * (TIME < 0.6)}, "acceleration")


def run_until(duration, strength):
    return simulate("configuration-2", push(strength), "nscd-rigid", duration=duration, accelerometers=False)


def test_a_wall_that_leans_as_the_window_ends_is_falling():
    whole = run_until(4.0, 1.3)
    assert whole.attrs["status"] == "collapsed"
    end = round(whole.attrs["end_time"] - AHEAD, 2)
    cut = run_until(end, 1.3)
    lean = np.degrees(2.0 * np.arcsin(abs(float(cut["orientation"].isel(time=-1, body=-1, quaternion=2)))))
    assert 12.0 < lean < 25.0
    assert cut.attrs["status"] == "falling"
    assert cut.attrs["reason"] == f"block-4 still falls at {end:.3f} s, when the window ends"
    assert cut.attrs["end_time"] == pytest.approx(end)
    # the same run so far
    np.testing.assert_array_equal(cut["position"], whole["position"].isel(time=slice(cut.sizes["time"])))


def test_a_wall_that_rocks_as_the_window_ends_has_completed():
    rocking = run_until(0.9, 1.2)
    assert np.abs(rocking["angular_velocity"].isel(time=-1)).max() > 0.01
    assert (rocking.attrs["status"], rocking.attrs["reason"]) == ("completed", "")
