"""Motion of the bodies from markers and accelerometers together."""

import numpy as np
import pytest
from known_blocks import readings, stack

from blockshake.forces.motion import smooth_motion
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.sensors.quiet_start import counted_from_rest

FREQUENCY, AMPLITUDE = 2.0, 2.0  # Hz, m/s2
OFFSET = 0.3  # m/s2, of every accelerometer


def _at_once(t):
    """Displacement of a table that moves from the first reading on, from rest, without a velocity in the end."""
    turns = 2.0 * np.pi * FREQUENCY
    return -AMPLITUDE / turns**2 * (np.sin(turns * t) - turns * t * np.exp(-t))


@pytest.mark.parametrize("name", ["slab", "block-1"])
def test_an_offset_is_known_where_the_table_moves_before_its_markers_show_it(name):
    structure = stack(1)
    test = readings(structure, lambda t: np.array([[_at_once(t), 0.0, 0.0]] * 2), noise=1e-4, noise_acc=0.02)
    test["accelerometer"] = test["accelerometer"] + OFFSET
    sensors = Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
    motion = smooth_motion(counted_from_rest(test, structure, sensors)[0], structure, sensors)
    body = structure.body_names.index(name)
    step = 1e-3
    true = (
        _at_once(motion.time - step) - 2.0 * _at_once(motion.time) + _at_once(motion.time + step)
    ) / step**2
    assert abs(np.mean(motion.acceleration[:, body, 0] - true)) < 0.005
