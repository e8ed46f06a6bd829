"""The estimate counts every run of a study, those of the friction search too."""

import time

import pytest

from blockshake.files import PACKAGE
from blockshake.simulation import cost
from blockshake.study.config import load_config

ROOT = PACKAGE.parents[1]


def test_the_search_of_the_mean_friction_is_counted(monkeypatch):
    """Every trial costs a CPU second a second of motion: hours are then the simulated seconds."""
    monkeypatch.chdir(ROOT)
    clock = {"now": 0.0}
    monkeypatch.setattr(time, "process_time", lambda: clock["now"])

    def simulated(structure, motion, model, parameters, duration, **options):
        clock["now"] += duration

    monkeypatch.setattr(cost, "simulate", simulated)
    config = load_config("config/study.yaml")
    search = config.friction_calibration
    assert search.runs == (6 + 2 * 2) * 10 * 3
    samples = 4 * 50 + 50 + 50 + 20 + 10 + 2 * (8 + 8 + 8 + 1)
    twins = 2 * 4 + 2 * 3  # of every model and case but configuration 4 with deformable blocks
    samples += 3 * twins  # one of them at half the step
    expected = (samples + search.runs) * 10.0 / 3600.0
    assert cost.estimate_hours(config) == pytest.approx(expected)
    without = config.model_copy(update={"friction_calibration": None})
    assert cost.estimate_hours(without) == pytest.approx(samples * 10.0 / 3600.0)
