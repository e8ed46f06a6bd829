"""The paper's study as it was run: CPU time of each finished part beside its estimate, and what identifies its result.

A part is finished where its result is in results/paper; the study may stop and go on, and its parts are here as they
come. CPU times are those of the jobs' logs, without the start of a job and its imports. A job that was killed and went
on has the CPU time of its last run alone.
"""

from pathlib import Path

from blockshake.cost.study_cost import study_cost
from blockshake.files import HOME, file_digest
from blockshake.log import read_cost

HEADER = (
    "part",
    "runs",
    "estimated [CPU min]",
    "taken [CPU min]",
    "taken over estimated",
    "digest of the result",
)
# logs of the jobs and result, by kind of part
_KINDS = {
    "samples": ("simulate_batch/{model}/{case}/*.log", "samples/{model}/{case}.nc"),
    "twins": ("run_twins/{model}/{case}.log", "twins/{model}/{case}.nc"),
    "calibration": ("compare_open_tests/{model}/{case}.log", "open-tests/{model}/{case}.nc"),
    "mean friction": ("calibrate_friction/{case}.log", "friction/{case}.json"),
    "fragility": ("climb_samples/{case}/*.log", "fragility/{case}.nc"),
}


def paper_rows(folder="."):
    """Rows under `HEADER` of the finished parts of the paper's study in a folder, the last of all together; none where
    nothing is finished."""
    logs, results = Path(folder, "logs", "paper"), Path(folder, "results", "paper")
    if not results.is_dir():
        return []
    rows, estimated, taken, runs = [], 0.0, 0.0, 0
    for part in study_cost(HOME / "config" / "paper.yaml"):
        kind, _, of = part.name.partition(" of ")
        if kind not in _KINDS:
            continue
        case, _, model = of.partition(", ")
        jobs, made = (one.format(case=case, model=model) for one in _KINDS[kind])
        if not (results / made).is_file():
            continue
        costs = [read_cost(path) for path in logs.glob(jobs)]
        seconds = sum(cost.cpu_time for cost in costs if cost is not None)
        rows.append(
            (part.name, part.count, *_cells(part.seconds, seconds), f"`{file_digest(results / made)}`")
        )
        estimated, taken, runs = estimated + part.seconds, taken + seconds, runs + part.count
    return [*rows, ("all of these", runs, *_cells(estimated, taken), "")] if rows else []


def _cells(estimated, taken):
    return f"{estimated / 60.0:.1f}", f"{taken / 60.0:.1f}", f"{taken / estimated:.2f}"
