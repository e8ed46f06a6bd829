import numpy as np
import pytest

from blockshake.dynamics.intensity import arias_intensity, motion_figures
from blockshake.dynamics.motion import GroundMotion, ground_motion, rest_table

GRAVITY = 9.80665


def test_constant_acceleration():
    # Arias (1970): pi / (2 g) a^2 T, gathered evenly, so that 5 to 95 % takes 0.9 T
    motion = ground_motion("constant", [0.0, 1.0, 10.0], {"x": [-2.0, -2.0, -2.0]}, "acceleration")
    figures = motion_figures(motion)
    assert figures["arias_intensity"] == pytest.approx(np.pi / (2.0 * GRAVITY) * 40.0, rel=1e-12)
    assert figures["significant_duration"] == pytest.approx(9.0, rel=1e-12)
    assert figures["peak_acceleration"] == 2.0
    assert figures["peak_displacement"] == pytest.approx(100.0)
    assert figures["end_displacement"] == pytest.approx(-100.0)
    assert figures["duration"] == 10.0


def test_linear_acceleration_is_squared_exactly():
    motion = ground_motion("ramp", [0.0, 3.0], {"y": [0.0, 3.0]}, "acceleration")
    assert arias_intensity(motion, "y")[-1] == pytest.approx(np.pi / (2.0 * GRAVITY) * 9.0, rel=1e-12)


def test_velocity_motion_has_the_acceleration_of_its_slopes():
    motion = ground_motion("triangle", [0.0, 1.0, 2.0], {"x": [0.0, 0.5, 0.0]}, "velocity")
    figures = motion_figures(motion)
    assert figures["peak_acceleration"] == pytest.approx(0.5)
    assert figures["peak_velocity"] == pytest.approx(0.5)
    assert figures["arias_intensity"] == pytest.approx(np.pi / (2.0 * GRAVITY) * 0.5)


def test_rest_has_no_intensity_and_no_duration():
    figures = motion_figures(GroundMotion("rest", rest_table(), "displacement"))
    assert figures["arias_intensity"] == 0.0
    assert figures["significant_duration"] == 0.0
