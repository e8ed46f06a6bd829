"""Parts of a cost, and that of the workflow's jobs in addition to their simulations."""

import os
import re
import subprocess
from typing import NamedTuple

from blockshake.errors import InputError

# CPU seconds of jobs in addition to their simulations. Their start, `_USUAL`, was measured with other work
# (2026-11-26), where the plan of the default study took `_PLANNED`; what some have to do with it is from the logs of
# that study, kernels are from decision 17.
_USUAL = 2.2
_FIXED = {
    "all": 0.0,
    "calibrate_stiffness": 5.3,
    "compare_models": 11.4,
    "compile_kernels": 28.5,
    "decide": 10.1,
    "make_diagnosis_report": 10.1,
    "make_report": 18.7,
    "measure_gain": 11.4,
    "measure_sensitivity": 5.3,
}
_PLANNED = 6.1  # CPU s
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
    The fixed costs of a job count times the CPU time of the plan over that on the machine where they were measured.
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
    seconds = sum(count * _FIXED.get(rule, _USUAL) for rule, count in counts.items())
    return CostPart("jobs in addition to their runs", sum(counts.values()), spent / _PLANNED * seconds)
