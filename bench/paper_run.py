"""The paper's study as it was run: the time of its finished parts, and of all of it, beside what was expected.

A part is finished where its result is in results/paper; the study may stop and go on, and its parts are here as they
come. Expected is what `make paper` said before it began and kept in logs/paper/estimate.txt. CPU times are those of the
jobs' logs, without the start of a job and its imports; a job that was killed and went on has the CPU time of its last
run alone. The time of the whole study is that in which jobs ran, starts and imports included.
"""

import re
from pathlib import Path

from timing import read_cost

from blockshake.files import file_digest

HEADER = ("part", "runs", "estimated [min]", "taken [min]", "taken over estimated", "digest of the result")
# logs of the jobs and result, by kind of part
_KINDS = {
    "samples": ("simulate_batch/{model}/{case}/[0-9]*.log", "samples/{model}/{case}.nc"),
    "twin": ("simulate_batch/{model}/{case}/half-step.log", "runs/{model}/{case}/half-step.nc"),
    "calibration": ("compare_open_tests/{model}/{case}.log", "open-tests/{model}/{case}.nc"),
    "fragility": ("climb_samples/{case}/*.log", "fragility/{case}.nc"),
}
_PART = re.compile(r"^(.+?) {2,}(\d+) +([\d.]+)$", re.MULTILINE)
_WHOLE = re.compile(r"about \d+ CPU minutes on this machine, (\d+) min on (\d+) cores")
_SHORTEST = 1.0  # min; an estimate below it is told to 0.1 min, too coarse for a ratio
_PAUSE = 60.0  # s; between jobs of one command less passes


def paper_rows(folder="."):
    """Rows under `HEADER` of the finished parts of the paper's study in a folder; none where none is finished or
    nothing was estimated.

    Then come the CPU time of all of these and, where the report is there, the duration of the whole study.
    """
    logs, results = Path(folder, "logs", "paper"), Path(folder, "results", "paper")
    estimate = logs / "estimate.txt"
    if not estimate.is_file():
        return []
    told = estimate.read_text(encoding="utf-8")
    rows, estimated, taken, runs = [], 0.0, 0.0, 0
    for part, count, minutes in _PART.findall(told):
        kind, _, of = part.partition(" of ")
        if kind not in _KINDS:
            continue
        case, _, model = of.partition(", ")
        jobs, made = (one.format(case=case, model=model) for one in _KINDS[kind])
        if not (results / made).is_file():
            continue
        costs = [read_cost(path) for path in logs.glob(jobs)]
        spent = sum(cost.cpu_time for cost in costs if cost is not None) / 60.0
        rows.append((part, count, *_cells(float(minutes), spent), f"`{file_digest(results / made)}`"))
        estimated, taken, runs = estimated + float(minutes), taken + spent, runs + int(count)
    if rows:
        rows.append(("CPU time of all of these", runs, *_cells(estimated, taken), ""))
    report = Path(folder, "reports", "paper.pdf")
    if report.is_file():
        expected, cores = _WHOLE.search(told).groups()
        whole = f"duration of the whole study on {cores} cores"
        rows.append((whole, "", *_cells(float(expected), _duration(logs)), f"`{file_digest(report)}`"))
    return rows


def _duration(logs):
    """Time in which jobs ran, of one or more commands [min]."""
    duration, end = 0.0, float("-inf")
    for job_begin, job_end in sorted(_times(logs)):
        duration += max(job_end - (end if job_begin < end + _PAUSE else job_begin), 0.0)
        end = max(end, job_end)
    return duration / 60.0


def _times(logs):
    """Beginnings and ends of the jobs [s]."""
    for path in logs.rglob("*.log"):
        cost = read_cost(path)
        if cost is not None:
            end = path.stat().st_mtime
            yield end - cost.wall_time, end


def _cells(estimated, taken):
    ratio = f"{taken / estimated:.2f}" if estimated >= _SHORTEST else ""
    return f"{estimated:.1f}", f"{taken:.1f}", ratio
