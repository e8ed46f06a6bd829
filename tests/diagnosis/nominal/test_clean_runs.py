"""Clean campaigns: all open tests by nominal models, seen and judged as if they had been measured."""

from dataclasses import replace

import pytest

from blockshake.diagnosis.nominal.clean_runs import simulate_clean_runs
from blockshake.diagnosis.nominal.planned_test import Clock, PlannedTest
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import PACKAGE, named_file
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.instruments import SlowNoise
from blockshake.store import Store

STRUCTURE = load_structure(PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml")
SENSORS = Sensors(
    marker_slow=SlowNoise(share=0.2, memory=0.1), accelerometer_slow=SlowNoise(share=0.2, memory=0.1)
)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    motion = load_motion(named_file("motions", "basso-tirreno"), 1.5)
    test = PlannedTest(
        STRUCTURE,
        motion,
        6.0,
        SENSORS,
        tuple(marker.name for marker in STRUCTURE.file.markers),
        (),
        Clock(rate=200.0),
    )
    planned = {"one": test, "two": replace(test, motion=motion.scaled(1.3))}
    channels = dict.fromkeys(planned, accelerometer_channels(STRUCTURE))
    store = Store(tmp_path_factory.mktemp("clean"), "source", lambda line: None)
    given = planned, channels, "nscd-rigid", 2, store
    return simulate_clean_runs(*given), given


def test_slow_noise_and_impacts_of_clean_runs_speak_for_no_cause(runs):
    found, _ = runs
    assert len(found) == 2
    for gains in found:
        assert {"eccentricity", "push", "unknown-force", "table-pitch", "impact-restitution"} <= gains.keys()
        assert max(gains.values()) < 6.0


def test_a_second_call_takes_what_the_store_has(runs, monkeypatch):
    found, (planned, channels, solver, count, store) = runs
    monkeypatch.setattr("blockshake.diagnosis.nominal.clean_runs._gains", None)
    assert simulate_clean_runs(planned, channels, solver, count, store) == found
