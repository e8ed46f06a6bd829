"""CPU times of jobs from the logs of a study: bench/schedule.py."""

import sys
from pathlib import Path

import pytest


@pytest.fixture
def schedule(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import schedule

    yield schedule
    sys.modules.pop("schedule")


def test_times_are_those_of_one_study_and_its_diagnoses(schedule, tmp_path):
    """Two batches of 10 and 5 samples of the study, one of another study, one ensemble, and a job that was killed."""
    for name, text in {
        "study/simulate_batch/ls-dem/one/000-009": "Took 9.0 s, 20.0 CPU s.\n",
        "study/simulate_batch/ls-dem/one/010-014": "Took 9.0 s, 20.0 CPU s.\n",
        "paper/simulate_batch/ls-dem/one/000-009": "Took 9.0 s, 900.0 CPU s.\n",
        "simulate_nominal/abc-ls-dem": "Took 9.0 s, 30.0 CPU s.\n",
        "study/simulate_batch/ls-dem/one/half-step": "Took 9.0 s, 6.0 CPU s.\n",
        "study/make_envelope/ls-dem/one": "sample 0, simulated: completed\n",
    }.items():
        path = tmp_path / "logs" / f"{name}.log"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    times = schedule.measured(tmp_path, "study")
    # a sample: 2 s in one batch, 4 s in the other, 3 s as half of the twin
    assert times["simulate_batch", ("ls-dem", "one")] == 3.0
    assert times["simulate_batch", ()] == pytest.approx(46.0 / 3.0)
    assert times["simulate_nominal", ()] == 30.0
    assert not [rule for rule, _ in times if rule == "make_envelope"]
    assert schedule.shares(tmp_path, "study") == [("simulate_batch", 3, 46.0), ("simulate_nominal", 1, 30.0)]
