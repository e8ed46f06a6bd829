"""A test ends where a block falls."""

import numpy as np
import pytest
import xarray as xr

from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.sensors.markers import marker_position

STRUCTURE = load_structure("configuration-1")
SENSORS = Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
TIME = np.arange(0.0, 4.0, 0.01)
TOP = 2


def readings(turn, drop=0.0):
    """Displacements of all markers while the top block turns about y [rad] and drops [m], histories over `TIME`."""
    start = marker_position(STRUCTURE, STRUCTURE.position, STRUCTURE.orientation)
    position = np.repeat(STRUCTURE.position[None], len(TIME), axis=0)
    position[:, TOP, 2] -= drop
    orientation = np.repeat(STRUCTURE.orientation[None], len(TIME), axis=0)
    orientation[:, TOP] = np.column_stack(
        [np.cos(turn / 2.0), np.zeros_like(turn), np.sin(turn / 2.0), np.zeros_like(turn)]
    )
    moved = marker_position(STRUCTURE, position, orientation) - start
    noise = np.random.default_rng(0).normal(0.0, SENSORS.marker_noise, moved.shape)
    names = [marker.name for marker in STRUCTURE.file.markers]
    return xr.Dataset(
        {"marker_displacement": (("time", "marker", "axis"), moved + noise)},
        {"time": TIME, "marker": names, "axis": ["x", "y", "z"]},
    )


def test_a_block_that_tips_over_ends_the_test():
    """From 2 s on the block turns by 1 rad/s: its axis leans by 45 degrees, pi/4, at 2.785 s."""
    test = readings(np.clip(TIME - 2.0, 0.0, None))
    fall = find_fall(test, STRUCTURE, SENSORS)
    assert fall.body == STRUCTURE.body_names[TOP]
    assert fall.time == pytest.approx(2.0 + np.pi / 4.0, abs=0.015)
    assert until_fall(test, fall)["time"].values[-1] < fall.time


def test_a_block_that_drops_off_its_support_ends_the_test():
    """The limit is half of the block's smallest extent, 0.4 m."""
    fall = find_fall(readings(np.zeros_like(TIME), 0.2 * TIME), STRUCTURE, SENSORS)
    assert fall.time == pytest.approx(2.0, abs=0.015)


def test_a_block_that_leans_and_comes_back_has_not_fallen():
    """A lean of 0.3 rad and a lean of 0.9 rad that comes back are no falls."""
    for lean in (0.3, 0.9):
        test = readings(lean * np.sin(np.pi * TIME / 4.0) ** 2)
        assert find_fall(test, STRUCTURE, SENSORS) is None
        assert until_fall(test, None) is test


def test_a_block_that_is_dropped_has_nothing_to_fall_from():
    """All blocks hang a metre apart; the lowest falls onto the slab."""
    mapping = STRUCTURE.file.model_dump(mode="json")
    for place, body in enumerate(mapping["bodies"]):
        body["position"][2] += float(place)
    hanging = build_structure(mapping, "hanging.yaml", STRUCTURE.folder)
    assert not hanging.touching.any()
    test = readings(np.zeros_like(TIME), np.clip(0.5 * 9.81 * TIME**2, 0.0, 1.0))
    assert find_fall(test, hanging, SENSORS) is None
