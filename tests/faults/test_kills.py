"""A study and a diagnosis killed at seeded random moments: the same command ends them, nothing finished is made twice.

``BLOCKSHAKE_MOMENTS`` is the number of kills of each. They go in turn to the whole process group, to Snakemake alone
and to one of its jobs. A work that is finished before all kills are spent is held against one that was never killed,
and begun anew.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import time
from collections import Counter

import numpy as np
import psutil
import pytest
import xarray as xr
from checkout import LIMIT
from ledger import DONE, LOST
from likeness import files, unlike
from work import WORKS, checkout_with_campaign, count_orphans, start

from blockshake.store import kept

pytestmark = pytest.mark.faults
MOMENTS = int(os.environ.get("BLOCKSHAKE_MOMENTS", "20"))
SEED = 1
KILLED = ("process group", "Snakemake alone", "one job")


@pytest.mark.parametrize("work", WORKS)
def test_a_work_killed_again_and_again(work, tmp_path):
    whole = checkout_with_campaign(tmp_path / "whole")
    started = time.monotonic()
    answer = whole.snakemake(*WORKS[work])
    assert answer.returncode == 0, answer.stdout + answer.stderr
    length = time.monotonic() - started
    killed = checkout_with_campaign(tmp_path / "killed")
    generator, lost, finished = np.random.default_rng(SEED), Counter(), {}
    for moment in range(MOMENTS):
        kind = KILLED[moment % len(KILLED)]
        # a command gets as far as its start-up allows: some kills find it planning, some at work
        ended = _kill(killed, work, kind, generator.uniform(0.0, length))
        DONE[f"{work}: {'ended before its kill' if ended else f'kill -9 of {kind}'}"] += 1
        lost["orphans"] += count_orphans(killed.folder)
        finished = _judge(killed.folder, finished, lost)
        if ended:
            lost["files unlike those of a whole run"] += len(unlike(whole.folder, killed.folder))
            _clear(killed.folder)
            finished = {}
    answer = killed.snakemake(*WORKS[work])
    lost["commands that did not end"] += answer.returncode != 0
    finished = _judge(killed.folder, finished, lost)
    lost["files unlike those of a whole run"] += len(unlike(whole.folder, killed.folder))
    LOST.update({f"{work}: {name}": count for name, count in lost.items()})
    assert finished
    assert sum(lost.values()) == 0, answer.stdout + answer.stderr


def _clear(folder):
    """Take all results away but the compiled kernels' marks."""
    for path in (folder / "results").iterdir():
        if path.name != "kernels":
            shutil.rmtree(path)
    shutil.rmtree(folder / "reports", ignore_errors=True)


def _kill(checkout, work, kind, delay):
    """Start a work, kill it after a while [s], and wait for its end: whether it ended well before."""
    command = start(checkout, work)
    with contextlib.suppress(subprocess.TimeoutExpired):
        said, _ = command.communicate(timeout=delay)
        assert command.returncode == 0, said
        return True
    if kind == "process group":
        os.killpg(command.pid, signal.SIGKILL)
    elif kind == "Snakemake alone":
        os.kill(command.pid, signal.SIGKILL)
    else:
        jobs = [one for one in psutil.Process(command.pid).children(True) if "python" in one.name()]
        for job in jobs[:1]:
            job.kill()
    command.communicate(timeout=LIMIT)
    return command.returncode == 0


def _judge(folder, finished, lost):
    """Count units that were made again and files that are not whole; give the finished units with their times."""
    units = {path: path.stat().st_mtime_ns for path in files(folder / "results" / "store", ".nc", ".json")}
    lost["finished units lost"] += len(finished.keys() - units.keys())
    lost["finished units made again"] += sum(
        units[path] != made for path, made in finished.items() if path in units
    )
    lost["half-written units"] += sum(not kept(path) for path in units)
    for path in files(folder / "results", ".nc"):
        try:
            xr.load_dataset(path)
        except (OSError, RuntimeError, ValueError):
            lost["half-written results"] += 1
    return units
