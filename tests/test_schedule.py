"""Schedules of bench/schedule.py: jobs read from a dry run, and how long they take on some cores."""

import sys
from pathlib import Path

import pytest

PRINTED = """
rule draw_samples:
    output: design.csv
    log: logs/paper/draw_samples.log
    jobid: 3

rule simulate_batch:
    input: design.csv, motion.yaml
    output: a.nc
    log: logs/paper/simulate_batch/ls-dem/configuration-1/000-009.log
    jobid: 2
"""


@pytest.fixture
def schedule(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import schedule

    yield schedule
    sys.modules.pop("schedule")


def test_jobs_of_a_dry_run(schedule):
    first, second = schedule.read_plan(PRINTED)
    assert (first.rule, first.key, first.samples, first.makes) == ("draw_samples", (), 1, ["design.csv"])
    assert (second.rule, second.key, second.samples) == ("simulate_batch", ("ls-dem", "configuration-1"), 10)
    assert second.needs == ["design.csv", "motion.yaml"]


@pytest.mark.parametrize(("cores", "hours"), [(1, 9.0), (2, 5.0), (64, 3.0)])
def test_hours_on_some_cores(cores, hours, schedule):
    """One job of an hour, three of one, two and two hours that wait for it, and one of three that waits for none."""
    jobs = [schedule.Job("first", (), 1, [], ["a"], 3600.0)]
    jobs += [schedule.Job("more", (), 1, ["a"], [str(span)], 3600.0 * span) for span in (1, 2, 2)]
    jobs.append(schedule.Job("alone", (), 1, ["elsewhere"], ["b"], 3 * 3600.0))
    assert schedule.hours(jobs, cores) == pytest.approx(hours)


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
