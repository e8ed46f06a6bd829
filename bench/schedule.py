"""How long a study takes on more cores: its jobs begun one after the other as cores get free, by measured job times.

The jobs and what each waits for are those of a dry run. The times are the CPU times in the logs of a finished default
study, of the same rule, model and configuration, by sample and by step. The start of a job and its imports, some 2 CPU
seconds, are not in them.
"""

import heapq
import re
import subprocess
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from statistics import mean

from timing import read_cost

from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.files import HOME
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.simulation.models import solver_of
from blockshake.study.ensembles.batch import HALF_STEP

_JOB = re.compile(r"^(?:localrule|rule|checkpoint) (\w+):\n((?:    .+\n)+)", re.MULTILINE)
_START = 10.0  # s; of a job of which no time is known


@dataclass
class Job:
    """A job of a plan: its rule, model, case and number of samples, its files, and its time [s]."""

    rule: str
    key: tuple
    samples: int
    needs: list
    makes: list
    seconds: float = _START


def planned(*arguments):
    """Jobs of a dry run of everything."""
    command = [
        sys.executable, "-m", "snakemake", "-n", "--forceall", "--workflow-profile", "none", "--nolock", "--cores", "1",
        *arguments,
    ]  # fmt: skip
    return read_plan(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def read_plan(text):
    """Jobs that a dry run prints."""
    jobs = []
    for rule, body in _JOB.findall(text):
        said = dict(re.findall(r"^    (\w+): (.+)$", body, flags=re.MULTILINE))
        needs, makes = ((said.get(name) or "").split(", ") for name in ("input", "output"))
        jobs.append(Job(rule, *_who(said.get("log", "")), needs, makes))
    return jobs


def measured(folder, study):
    """Mean seconds of the jobs of a finished study, by rule, model and case; of batches those of a sample."""
    spent = defaultdict(list)
    for rule, path, seconds in _jobs_done(folder, study):
        parts = path.with_suffix("").parts
        key, samples = _batch(parts[parts.index(rule) + 1 :])
        spent[rule, key].append(seconds / samples)
        if key:
            spent[rule, ()].append(seconds)
    return {key: mean(values) for key, values in spent.items()}


def shares(folder, study):
    """Jobs and CPU seconds of every rule of a finished study, the dearest first."""
    spent = defaultdict(list)
    for rule, _, seconds in _jobs_done(folder, study):
        spent[rule].append(seconds)
    return sorted(((rule, len(each), sum(each)) for rule, each in spent.items()), key=lambda row: -row[2])


def _jobs_done(folder, study):
    """Rule, log and CPU seconds of the jobs of a study in a folder, its diagnoses and ensembles included."""
    rules = {path.stem for path in (HOME / "workflow" / "scripts").glob("*.py")}
    logs = Path(folder, "logs")
    for path in sorted(logs.rglob("*.log")):
        parts, cost = path.relative_to(logs).with_suffix("").parts, read_cost(path)
        named = rules & set(parts)
        if parts[0] in {study, "diagnosis", *rules} and named and cost is not None:
            (rule,) = named
            yield rule, path, cost.cpu_time


def _who(log):
    """Model and case of a job, and the number of its samples, from the path of its log."""
    return _batch(tuple(log.removesuffix(".log").split("/")[3:]))


def _batch(parts):
    """Model and case of a job, and the number of its samples, from the end of a path of its own; two are as a twin."""
    if parts[-1:] == (HALF_STEP,):
        return parts[:-1], 2
    batch = re.fullmatch(r"(\d+)-(\d+)", parts[-1]) if parts else None
    return (parts[:-1], int(batch[2]) - int(batch[1]) + 1) if batch else (parts, 1)


def timed_study(jobs, config, done, times):
    """Give the jobs of a study their times, from those of the study that was done.

    Runs and climbs take as long as there by sample and by step, climbs of a case that did not climb as those that did;
    open tests as their runs; all other jobs as there, whatever the number of samples.
    """
    for job in jobs:
        if job.rule == "simulate_batch":
            job.seconds = (
                job.samples * times["simulate_batch", _done(job.key)] * _steps(config, done, *job.key)
            )
        elif job.rule == "climb_samples":
            (case,) = job.key
            known = times.get((job.rule, job.key))
            each = known or times[job.rule, ()] / done.samples_per_job
            job.seconds = job.samples * each * _steps(config, done, config.fragility.model, case)
        elif job.rule == "compare_open_tests":
            model, case = job.key
            runs = config.calibration.size * len(load_campaign(config.case(case).measured.campaign).open)
            # the records are as long as the windows of the study that was done
            steps = done.models[solver_of(model).name].time_step / config.models[model].time_step
            steps *= config.calibration.steps(config.ensemble.distributions, solver_of(model))
            job.seconds = runs * times["simulate_batch", _done(job.key)] * steps
        else:
            job.seconds = times.get((job.rule, job.key), times.get((job.rule, ()), _START))
    return jobs


def _done(key):
    """Model and case of the study that was done, whose models have the names of their solvers."""
    model, case = key
    return solver_of(model).name, case


def _steps(config, done, model, case):
    """Steps of a run over those of the run that was done."""
    counts = []
    for one, name in ((config, model), (done, solver_of(model).name)):
        (duration,) = [found.duration for found in one.cases if found.name == case]
        counts.append(duration / one.models[name].time_step)
    return counts[0] / counts[1]


def hours(jobs, cores):
    """Hours until the last job ends: a free core takes the longest of the jobs that wait for nothing more."""
    maker = {name: number for number, job in enumerate(jobs) for name in job.makes if name}
    waits = [{maker[name] for name in job.needs if name in maker} for job in jobs]
    follow = defaultdict(list)
    for number, needed in enumerate(waits):
        for other in needed:
            follow[other].append(number)
    ready = [(-jobs[number].seconds, number) for number, needed in enumerate(waits) if not needed]
    heapq.heapify(ready)
    running, now, ended = [], 0.0, 0
    while ready or running:
        while ready and len(running) < cores:
            _, number = heapq.heappop(ready)
            heapq.heappush(running, (now + jobs[number].seconds, number))
        now, number = heapq.heappop(running)
        ended += 1
        for other in follow[number]:
            waits[other].discard(number)
            if not waits[other]:
                heapq.heappush(ready, (-jobs[other].seconds, other))
    assert ended == len(jobs)
    return now / 3600.0


def deep_diagnosis(campaign, times):
    """Jobs of a deep diagnosis that finds a cause, from the times of a standard one."""
    done, plan = (plan_diagnosis(campaign, effort) for effort in ("standard", "deep"))
    more = plan.runs / len(plan.tests) / (done.runs / len(done.tests))
    of_cause = plan.runs_of_cause / done.runs_of_cause

    def as_there(rule, needs, makes, factor=1.0):
        return Job(rule, (), 1, needs, makes, factor * times.get((rule, ()), _START))

    ensembles = [f"{test} {model}" for test in plan.tests for model in MODELS]
    extended = [f"extended {model}" for model in MODELS]
    return [
        *(as_there("simulate_nominal", [], [name], more) for name in ensembles),
        as_there("decide", [], ["decision"]),
        as_there("describe_misfit", ["decision", *ensembles], ["misfit"], more),
        *(as_there("extend_model", ["decision", *ensembles], [name], of_cause) for name in extended),
        as_there("measure_gain", extended, ["gain"], of_cause),
        as_there("make_diagnosis_report", ["gain", "misfit"], ["report"]),
    ]
