"""A test whose table followed another record of the campaign than the one that its entry names."""

import re

import numpy as np
import pytest
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, MeasuredTest
from blockshake.measurement.campaigns.clocks import from_command
from blockshake.measurement.campaigns.commanded_motion import another_record_remarks
from blockshake.measurement.sensors.instruments import Sensors
from blockshake.measurement.sensors.markers import slab_displacement

STRUCTURE = load_structure("configuration-1")


def remarks(folder, followed, stated, scale=1.0):
    """Remarks on a table that follows one motion, late by 1.3 s, where another is stated, with 1 mm of own motion."""
    motion = load_motion(followed, scale)
    time = np.arange(0.0, motion.duration, 0.005)
    moved = motion.evaluate(time - 1.3)[:, 0] + 1e-3 * np.sin(9.0 * time)
    values = np.zeros((len(time), 1, 3))
    values[:, 0, 0] = moved + np.random.default_rng(1).normal(0.0, 1e-4, len(time))
    coordinates = {"time": time, "marker": ["slab-face"], "axis": list("xyz")}
    test = xr.Dataset({"marker_displacement": (("time", "marker", "axis"), values)}, coordinates)
    entry = MeasuredTest(name="t1", file="t1.nc", motion=stated, scale=1.0, role="fit")
    campaign = Campaign(folder, "made", "configuration-1", Sensors(), {"t1": entry})
    test = from_command(test, STRUCTURE, load_motion(stated, 1.0))
    return another_record_remarks(test, slab_displacement(test, STRUCTURE), campaign, entry)


@pytest.mark.parametrize("scale", [0.5, 1.0, 2.0])
def test_the_motion_that_the_table_followed_is_named(scale, tmp_path):
    (remark,) = remarks(tmp_path, "basso-tirreno", "alkion", scale)
    words = (
        r"the table follows basso-tirreno \(correlation of velocities (0\.9\d|1\.00)\), not alkion \(0\.\d+\)"
    )
    assert re.match(words, remark)


@pytest.mark.parametrize("name", ["alkion", "basso-tirreno"])
def test_the_stated_motion_makes_no_remark(name, tmp_path):
    assert remarks(tmp_path, name, name) == []
