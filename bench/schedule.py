"""CPU time of the jobs of a finished study, from their logs; the start of a job and its imports are not in them."""

import re
from collections import defaultdict
from pathlib import Path
from statistics import mean

from timing import read_cost

from blockshake.files import HOME
from blockshake.study.ensembles.batch import HALF_STEP


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


def _batch(parts):
    """Model and case of a job, and the number of its samples, from the end of a path of its own; two are as a twin."""
    if parts[-1:] == (HALF_STEP,):
        return parts[:-1], 2
    batch = re.fullmatch(r"(\d+)-(\d+)", parts[-1]) if parts else None
    return (parts[:-1], int(batch[2]) - int(batch[1]) + 1) if batch else (parts, 1)
