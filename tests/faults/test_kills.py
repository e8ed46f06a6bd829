"""A small study killed at seeded random moments: the same command ends it, nothing finished is made twice.

``BLOCKSHAKE_MOMENTS`` is the number of kills. They go in turn to the whole process group, to Snakemake alone and to one
of its jobs. A study that is finished before all kills are spent is held against one that was never killed, and begun
anew.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter

import numpy as np
import psutil
import pytest
import xarray as xr
from checkout import LIMIT, Checkout
from likeness import count_unlike, files

from blockshake.store import kept

pytestmark = pytest.mark.faults
MOMENTS = int(os.environ.get("BLOCKSHAKE_MOMENTS", "20"))
SEED = 1
TARGETS = ("all", "ladder")
KILLED = ("process group", "Snakemake alone", "one job")
GRACE = 10.0  # s; in which jobs end with their command, on a machine that may be busy


def test_a_study_killed_again_and_again(tmp_path, capsys):
    whole = Checkout(tmp_path / "whole")
    started = time.monotonic()
    assert whole.snakemake(*TARGETS).returncode == 0
    length = time.monotonic() - started
    killed = Checkout(tmp_path / "killed")
    generator, done, lost, finished = np.random.default_rng(SEED), Counter(), Counter(), {}
    for moment in range(MOMENTS):
        kind = KILLED[moment % len(KILLED)]
        # a command gets as far as its start-up allows: some kills find it planning, some at work
        ended = _kill(killed, kind, generator.uniform(0.0, length))
        done["ended before its kill" if ended else f"kill -9 of {kind}"] += 1
        lost["orphans"] += _count_orphans(killed.folder)
        finished = _judge(killed.folder, finished, lost)
        if ended:
            lost["files unlike those of a whole run"] += count_unlike(whole.folder, killed.folder)
            _clear(killed.folder)
            finished = {}
    answer = killed.snakemake(*TARGETS)
    lost["commands that did not end"] += answer.returncode != 0
    finished = _judge(killed.folder, finished, lost)
    lost["files unlike those of a whole run"] += count_unlike(whole.folder, killed.folder)
    with capsys.disabled():
        sys.stdout.write(_table("done to a study", done) + _table("lost", lost))
    assert finished
    assert sum(lost.values()) == 0, answer.stdout + answer.stderr


def _table(title, counts):
    rows = [f"{name:42}{count:4}\n" for name, count in sorted(counts.items())]
    return f"\n{title:42}times\n" + "".join(rows)


def _clear(folder):
    """Take all results away but the compiled kernels' marks."""
    for path in (folder / "results").iterdir():
        if path.name != "kernels":
            shutil.rmtree(path)
    shutil.rmtree(folder / "reports", ignore_errors=True)


def _kill(checkout, kind, delay):
    """Start the study, kill it after a while [s], and wait for its end: whether it ended well before."""
    command = subprocess.Popen(
        checkout.command(*TARGETS), cwd=checkout.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    with contextlib.suppress(subprocess.TimeoutExpired):
        assert command.wait(delay) == 0
        return True
    if kind == "process group":
        os.killpg(command.pid, signal.SIGKILL)
    elif kind == "Snakemake alone":
        os.kill(command.pid, signal.SIGKILL)
    else:
        jobs = [one for one in psutil.Process(command.pid).children(True) if "python" in one.name()]
        for job in jobs[:1]:
            job.kill()
    return command.wait(LIMIT) == 0


def _count_orphans(folder):
    """Processes that work in the folder though no command does."""
    deadline = time.monotonic() + GRACE
    while (left := [one for one in psutil.process_iter() if _works_in(one, folder)]) and (
        time.monotonic() < deadline
    ):
        time.sleep(0.1)
    for one in left:
        one.kill()
    return len(left)


def _works_in(process, folder):
    try:
        return process.cwd() == str(folder)
    except psutil.Error:
        return False


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
