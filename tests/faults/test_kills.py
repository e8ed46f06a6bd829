"""A study and a diagnosis killed at seeded random moments: the same command ends them, nothing finished is made twice.

``BLOCKSHAKE_MOMENTS`` is the number of kills of each. They go in turn to the whole process group, to Snakemake alone
and to one of its jobs. A work that ends before its kill is held against one that was never killed, and begun anew.
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
from work import BOTH, WORKS, checkout_with_campaign, count_orphans, start

from blockshake.store import kept

pytestmark = pytest.mark.faults
MOMENTS = int(os.environ.get("BLOCKSHAKE_MOMENTS", "20"))
SEED = 1
KILLED = ("process group", "Snakemake alone", "one job")


@pytest.mark.parametrize("work", BOTH)
def test_a_work_killed_again_and_again(work, whole, tmp_path):
    checkout, length = whole(work)
    killed = checkout_with_campaign(tmp_path / "killed")
    generator, lost, finished = np.random.default_rng(SEED), Counter(), {}
    kills = 0
    while kills < MOMENTS:
        kind = KILLED[kills % len(KILLED)]
        # some kills find a command planning, some at work; it goes on from the one before, so that half of the time
        # a whole work takes reaches all parts of one
        ended = _kill(killed, work, kind, generator.uniform(0.0, 0.5 * length))
        DONE[
            f"{work}: {'ended before its kill, held against a whole one' if ended else f'kill -9 of {kind}'}"
        ] += 1
        kills += not ended
        lost["orphans"] += count_orphans(killed.folder)
        finished = judge(killed.folder, finished, lost)
        if ended:
            lost["files unlike those of a whole run"] += len(unlike(checkout.folder, killed.folder))
            _clear(killed.folder)
            finished = {}
    answer = killed.snakemake(*WORKS[work])
    lost["commands that did not end"] += answer.returncode != 0
    finished = judge(killed.folder, finished, lost)
    lost["files unlike those of a whole run"] += len(unlike(checkout.folder, killed.folder))
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
        _kill_a_job(command)
    command.communicate(timeout=LIMIT)
    return command.returncode == 0


def _kill_a_job(command):
    """Kill the first job, as soon as there is one, of a command that has not ended."""
    killed = False
    while command.poll() is None and not killed:
        with contextlib.suppress(psutil.NoSuchProcess):  # it ended this moment
            for job in psutil.Process(command.pid).children(True):
                if not killed and "python" in job.name():
                    job.kill()
                    killed = True
        time.sleep(0.05)


def judge(folder, finished, lost):
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
