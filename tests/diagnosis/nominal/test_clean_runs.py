"""Clean campaigns: all open tests by nominal models, seen and judged as if they had been measured."""

from dataclasses import replace

import pytest
from simulated_tests import DURATION, seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.answer.thresholds import by_odds, thresholds_of
from blockshake.diagnosis.nominal.clean_runs import simulate_clean_runs
from blockshake.diagnosis.nominal.nominal_model import MODELS
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


@pytest.mark.slow
def test_clean_runs_of_walls_with_loops_raise_the_threshold_of_a_changed_edge_and_nothing_is_called(tmp_path):
    """Strong tests of two walls under a bridge, nodes farther apart than in any nominal model."""
    motions = {"one": ("alkion", 2.75), "two": ("alkion", 3.5), "three": ("basso-tirreno", 2.75)}
    model = "ls-dem", {"ls_dem.node_spacing": 0.16}, 1e-4
    seen = seen_tests("configuration-3", motions, model=model)
    structure = load_structure("configuration-3")
    markers = tuple(marker.name for marker in structure.file.markers)
    planned = {
        name: PlannedTest(
            structure,
            load_motion(named_file("motions", motion), scale),
            DURATION,
            Sensors(),
            markers,
            (),
            Clock(),
        )
        for name, (motion, scale) in motions.items()
    }
    channels = dict.fromkeys(planned, accelerometer_channels(structure))
    store = Store(tmp_path, "source", lambda line: None)
    runs = [run for solver in MODELS for run in simulate_clean_runs(planned, channels, solver, 1, store)]
    thresholds = thresholds_of(runs)
    decision = decide(seen, thresholds=thresholds).decision
    assert thresholds.of("changed-edge") > by_odds("changed-edge")
    assert decision.decision == "none", [(part.readings, part.gains) for part in decision.parts]
