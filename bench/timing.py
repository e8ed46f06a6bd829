"""Cost of jobs, and of the simulations of a study, from the logs of the jobs."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

_COST = re.compile(r"^Took ([\d.]+) s, ([\d.]+) CPU s\.$", re.MULTILINE)


class Cost(NamedTuple):
    """Cost of a job, without its imports [s]."""

    wall_time: float
    cpu_time: float


class Timing(NamedTuple):
    """Cost of one case by one model, as its jobs last ran.

    Attributes
    ----------
    model, case : str
    jobs, samples : int
        Jobs whose log tells their cost, and the samples in their batches.
    simulated, cpu_time, wall_time : float
        Time simulated in those samples and spent on them, start of the jobs and imports left out [s]; NaN where no
        log tells the cost.
    """

    model: str
    case: str
    jobs: int
    samples: int
    simulated: float
    cpu_time: float
    wall_time: float

    @property
    def cpu_per_simulated(self):
        """CPU time over simulated time [1]; NaN where nothing was simulated."""
        return self.cpu_time / self.simulated if self.simulated > 0.0 else np.nan


def read_cost(path):
    """`Cost` in the log of a job; None where the job was killed or has no log.

    The CPU time is that of the job's process and of the programs that the process started and waited for. Snakemake's
    own benchmarks look every 30 s at a job of more than 15 s, and lose the CPU time after the last look.
    """
    found = _COST.findall(Path(path).read_text(encoding="utf-8")) if Path(path).is_file() else []
    return Cost(*map(float, found[-1])) if found else None


def read_timings(logs, samples):
    """Costs of all cases and models, a tuple of `Timing`.

    Parameters
    ----------
    logs : str or path
        Folder with ``simulate_batch/MODEL/CASE/FIRST-LAST.log``.
    samples : dict of (str, str) to xarray.Dataset
        By model and case, with ``end_time(sample)`` [s].
    """
    timings = []
    for (model, case), figures in samples.items():
        costs, covered = [], set()
        for path in sorted(Path(logs, "simulate_batch", model, case).glob("[0-9]*-*.log")):
            first, last = (int(part) for part in path.stem.split("-"))
            inside = [int(sample) for sample in figures["sample"].values if first <= sample <= last]
            if (
                inside and (cost := read_cost(path)) is not None
            ):  # else of an earlier configuration, or killed
                costs.append(cost)
                covered.update(inside)
        simulated = float(figures["end_time"].sel(sample=sorted(covered)).sum())
        wall_time, cpu_time = map(sum, zip(*costs, strict=True)) if costs else (np.nan, np.nan)
        timings.append(Timing(model, case, len(costs), len(covered), simulated, cpu_time, wall_time))
    return tuple(timings)
