"""A synthetic test of a stack that follows the table, to be spoilt by tests of the reader."""

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.markers import marker_position

NOISE = 1e-4  # m
ACCELEROMETER_NOISE = 0.02  # m/s2
STRUCTURE = load_structure("configuration-1")
MARKERS = [marker.name for marker in STRUCTURE.file.markers]
CHANNELS = ["slab-acc-x", "block-1-acc-x"]
MOTION = load_motion("basso-tirreno")
PLACES = marker_position(STRUCTURE, STRUCTURE.position, STRUCTURE.orientation)
CAMPAIGN = """
name: mine
structure: configuration-1
sensors: {{marker_noise: {noise}, accelerometer_noise: 0.02}}
tests:
  - {{name: t1, file: {file}, motion: {motion}, scale: {scale}, role: {role}}}
"""


def resting_stack():
    """Every marker and channel reads the table, with noise; one marker has a gap."""
    generator = np.random.default_rng(1)
    time, time_acc = np.arange(2001) / 200.0, np.arange(5120) / 512.0
    position = np.zeros((len(time), len(MARKERS), 3))
    position[..., 0] = MOTION.evaluate(time)[:, :1] - MOTION.evaluate(time[:1])[0, 0]
    position += generator.normal(0.0, NOISE, position.shape)
    acceleration = np.repeat(MOTION.evaluate(time_acc, 2)[:, :1], len(CHANNELS), axis=1)
    acceleration += generator.normal(0.0, ACCELEROMETER_NOISE, acceleration.shape)
    displacement = position - position[0]
    displacement[300:303, 2] = np.nan
    return xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"}),
            "marker_initial_position": (("marker", "axis"), PLACES.copy()),
            "accelerometer": (("time_acc", "channel"), acceleration, {"units": "m s-2"}),
        },
        {"time": time, "marker": MARKERS, "axis": ["x", "y", "z"], "time_acc": time_acc, "channel": CHANNELS},
    )


def write_campaign(folder, test, file="t1.nc", role="fit", noise=NOISE, motion="basso-tirreno", scale="1.0"):
    """A campaign of that one test; without a test, of the file that is there."""
    if test is not None:
        test.to_netcdf(folder / file)
    text = CAMPAIGN.format(file=file, role=role, noise=noise, motion=motion, scale=scale)
    (folder / "campaign.yaml").write_text(text)
    return folder
