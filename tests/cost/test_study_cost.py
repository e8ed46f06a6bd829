"""The estimate counts every run of a study, those of the friction search and of the diagnosis too."""

import sys
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.cost import diagnosis_cost, study_cost
from blockshake.cost.jobs import CostPart, measured_jobs, planned_jobs
from blockshake.diagnosis.nominal.plan import EFFORTS, Plan, plan_diagnosis
from blockshake.errors import InputError
from blockshake.files import PACKAGE

ROOT = PACKAGE.parents[1]


@pytest.fixture(autouse=True)
def _in_the_checkout(monkeypatch):
    monkeypatch.chdir(ROOT)


def test_every_run_of_the_default_study_is_counted(monkeypatch):
    """Every run costs a CPU second a second of motion: CPU seconds are then the simulated seconds."""
    monkeypatch.setattr(
        study_cost, "run_seconds", lambda structure, motion, settings, duration, runs: duration
    )
    monkeypatch.setattr(study_cost, "diagnosis_cost", lambda folder, effort, tried: [])
    monkeypatch.setattr(study_cost, "planned_jobs", lambda command: CostPart("jobs", 0, 0.0))
    samples = 2 * 4 * 50 + 2 * (6 + 6 + 6 + 1)
    twins = 4 * 4 - 2  # of every model and case, but for the two that run one sample
    climbs = 2 * 20 * 23  # two cases, 20 samples, 0.5 to 6 by 0.25
    # four cases by LS-DEM of two open tests, the first one by rigid blocks too; steps go with the root of
    # the stiffness, evenly drawn in its logarithm from 0.03 to 3
    softer = 2.0 * (np.sqrt(3.0) - np.sqrt(0.03)) / np.log(100.0)
    opened = 20 * (softer * 4 * 2 + 2)
    parts = study_cost.study_cost("config/study.yaml")
    runs = samples + 2 * twins + climbs + opened
    # an open test drives from the start of its command on, 2 to 4 ms after its first reading
    seconds = sum(part.seconds for part in parts)
    # the mean of exp(u / 2) over the middles of strata is below that of the range by their width squared over 96
    strata = (np.log(100.0) / 20) ** 2 / 96.0
    assert runs * 10.0 - (0.004 + 10.0 * strata) * opened < seconds <= runs * 10.0


def test_every_simulated_test_of_a_diagnosis_is_counted(monkeypatch):
    """A simulation costs a second and the readings nothing: CPU seconds are then the numbers of simulated tests."""
    monkeypatch.setattr(diagnosis_cost, "_seconds_of_draws", lambda planned, model: 1.0)
    tried = []
    monkeypatch.setattr(diagnosis_cost, "simulate_clean_runs", lambda planned, *others: tried.append(planned))
    monkeypatch.setattr(diagnosis_cost, "cpu_seconds", lambda call: call() or 1.0)
    folder, known = "data/virtual-campaign/configuration-2", {}
    plan = plan_diagnosis(folder, "standard")
    *clean, first = diagnosis_cost.diagnosis_cost(folder, "quick", {})
    assert [len(one) for one in tried] == [1] * 4  # a test by each solver, once to load its kernels
    clean = [one for one in (*clean, first) if one.name.startswith("clean campaigns of 6 tests, ")]
    # one draw a solver of six tests of equal length
    assert [(one.count, one.seconds) for one in clean] == [(1, 6.0), (1, 6.0)]
    *clean, of_cause = diagnosis_cost.diagnosis_cost(folder, "standard", known)
    ensembles, clean = clean[2:], clean[:2]
    assert [(one.count, one.seconds) for one in clean] == [(10, 60.0), (10, 60.0)]
    assert sum(part.seconds for part in ensembles) == plan.runs == 2 * 3 * (40 + 4)
    # solvers; open tests with the cause; four ensembles and twins of two sealed tests
    assert of_cause.seconds == 2 * (3 * 40 + 2 * (4 * 12 + 4))
    again = diagnosis_cost.diagnosis_cost(folder, "standard", known)
    assert [one.name for one in again[2:]] == [of_cause.name]  # the ensembles are there


@dataclass(frozen=True)
class _OfOutcomes:
    tests: dict
    kind = SimpleNamespace(batches=True)


def test_outcomes_of_a_diagnosis_are_counted(monkeypatch):
    """Two tests are tried, each by as many models as a test has."""
    monkeypatch.setattr(diagnosis_cost, "simulate_outcomes", lambda campaign, *others: len(campaign.tests))
    monkeypatch.setattr(diagnosis_cost, "cpu_seconds", lambda call: float(call()))
    plan = Plan(_OfOutcomes(dict.fromkeys(range(30))), EFFORTS["quick"], [], [])
    monkeypatch.setattr(diagnosis_cost, "plan_diagnosis", lambda folder, effort: plan)
    (part,) = diagnosis_cost.diagnosis_cost("folder", "quick", {})
    assert part == CostPart("outcomes of 30 tests, nscd-rigid", 120, 30.0)


def test_jobs_are_those_of_the_workflow():
    """Jobs of the table that Snakemake prints, without its total; `all` costs nothing."""
    table = "job    count\\n-----  -----\\nall        1\\nmake_envelope        10\\ntotal        11\\n"
    # a process that is too short for the system's clock would cost nothing
    part = planned_jobs([sys.executable, "-c", f"sum(range(10**7)); print('{table}')"])
    assert part.count == 11
    assert part.seconds > 0.0


def test_jobs_that_left_a_benchmark_cost_what_it_states(tmp_path):
    """Means by rule, whatever case they are of; a job that may have found its runs in the store tells nothing."""
    rows = {
        "small/make_envelope/ls-dem/one": 2.0,
        "small/make_envelope/ls-dem/two": 4.0,
        "small/make_report": 20.0,
        "small/simulate_batch/ls-dem/one/000-004": 1.0,
    }
    for name, seconds in rows.items():
        path = tmp_path / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\th:m:s\tcpu_time\n{3 * seconds}\t0:00:01\t{seconds}\n")
    rules = {"make_envelope", "make_report", "simulate_batch", "decide"}
    assert measured_jobs(tmp_path / "small", rules) == {"make_envelope": 3.0, "make_report": 20.0}
    assert measured_jobs(tmp_path / "nowhere", rules) == {}


def test_a_plan_that_fails_says_why():
    """The workflow's own last line is the reason."""
    with pytest.raises(InputError, match="no such file"):
        planned_jobs([sys.executable, "-c", "import sys; sys.exit('no such file')"])
