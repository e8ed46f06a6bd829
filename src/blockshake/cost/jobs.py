"""Parts of a cost, and that of the workflow's jobs in addition to their simulations."""

import os
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from blockshake.errors import InputError

# CPU seconds of jobs in addition to their simulations. Their start, `_USUAL`, was measured with other work
# (2026-11-26), where the plan of the default study took `_PLANNED`; what some have to do with it is from the logs of
# that study, kernels are from decision 17.
_USUAL = 2.2
_FIXED = {
    "all": 0.0,
    "calibrate_stiffness": 5.3,
    "compare_models": 11.4,
    "compile_kernels": 37.0,
    "decide": 10.1,
    "make_diagnosis_report": 10.1,
    "make_report": 18.7,
    "measure_gain": 11.4,
    "measure_sensitivity": 5.3,
}
_PLANNED = 6.1  # CPU s
# rules whose benchmarks do not tell what they cost anew: they simulate, or take what they need from the store
_KEEPING = {
    "calibrate_stiffness",
    "climb_samples",
    "compare_open_tests",
    "extend_model",
    "simulate_batch",
    "simulate_clean",
    "simulate_nominal",
    "simulate_outcomes",
}
_ROW = re.compile(r"^(\w+) +(\d+)$", re.MULTILINE)


class CostPart(NamedTuple):
    """Runs or jobs of one kind."""

    name: str
    count: int
    seconds: float  # CPU time of all of them [s]


def planned_jobs(command):
    """`CostPart` of the workflow's jobs next to the simulations that are tried, if nothing is made yet.

    Parameters
    ----------
    command : list of str
        Starts the workflow.

    Raises
    ------
    InputError
        The workflow refuses its files.

    Notes
    -----
    A job costs what the benchmarks of its rule in ``logs`` of the current folder state, in the mean. Without any, fixed
    costs count, times the CPU time of the plan over that on the machine where they were measured.
    """
    before = os.times()
    done = subprocess.run(
        [*command, "--dry-run", "--forceall", "--quiet", "rules"], capture_output=True, text=True, check=False
    )
    after = os.times()
    if done.returncode:
        raise InputError("the workflow", "", f"cannot be planned: {' '.join(done.stderr.split()[-30:])}")
    counts = {rule: int(count) for rule, count in _ROW.findall(done.stdout + done.stderr)}
    counts.pop("total", None)
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    measured = measured_jobs("logs", counts)
    seconds = sum(
        count * measured.get(rule, spent / _PLANNED * _FIXED.get(rule, _USUAL))
        for rule, count in counts.items()
    )
    return CostPart("jobs in addition to their runs", sum(counts.values()), seconds)


def measured_jobs(folder, rules):
    """CPU seconds of a job by rule, mean of the benchmarks in a folder of logs; of ``rules`` that keep nothing."""
    found = {}
    for path in Path(folder).rglob("*.tsv"):
        rule = next((part for part in path.with_suffix("").parts if part in rules), None)
        if rule is not None and rule not in _KEEPING:
            found.setdefault(rule, []).extend(pd.read_csv(path, sep="\t")["cpu_time"])
    return {rule: float(np.nanmean(seconds)) for rule, seconds in found.items() if np.isfinite(seconds).any()}
