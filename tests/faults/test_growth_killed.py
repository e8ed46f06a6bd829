"""A study that grows, killed at seeded random moments: the same command reaches the same size and the same results."""

import contextlib
import os
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from checkout import LIMIT, Checkout
from ledger import DONE, LOST
from likeness import unlike
from test_kills import judge
from work import count_orphans

from blockshake.files import load_json

pytestmark = pytest.mark.faults
MOMENTS = int(os.environ.get("BLOCKSHAKE_MOMENTS", "20")) // 2
SEED = 2
LARGEST = 30.0  # s, until a kill: on two cores a small study that grows takes some twice as long
_COMMAND = Path(sys.executable).with_name("blockshake"), "study", "config/small.yaml", "--cores", "2"


def growing(folder):
    """A small study that begins with ten samples and cannot be as accurate as requested: it ends at thirty."""
    checkout = Checkout(folder)
    ensemble = checkout.config["ensemble"] | {
        "size": 30, "batch": 10, "until": {"collapse probability": 0.01}
    }  # fmt: skip
    checkout.write_config(checkout.config | {"ensemble": ensemble, "samples_per_job": 5})
    return checkout


def start(checkout):
    """Start the command of a study in a process group of its own."""
    return subprocess.Popen(
        _COMMAND, cwd=checkout.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        start_new_session=True,
    )  # fmt: skip


def test_a_growing_study_killed_again_and_again(tmp_path):
    whole, killed = growing(tmp_path / "whole"), growing(tmp_path / "killed")
    answer, _ = start(whole).communicate(timeout=LIMIT)
    assert "stopped at 30 samples, the largest size" in answer
    generator, lost, finished = np.random.default_rng(SEED), Counter(), {}
    for _ in range(MOMENTS):
        command = start(killed)
        with contextlib.suppress(subprocess.TimeoutExpired):
            command.communicate(timeout=generator.uniform(0.0, LARGEST))
        with contextlib.suppress(ProcessLookupError):
            os.killpg(command.pid, signal.SIGKILL)
        command.communicate(timeout=LIMIT)
        DONE["growing study: kill -9 of process group"] += 1
        lost["orphans"] += count_orphans(killed.folder)
        finished = judge(killed.folder, finished, lost)
    answer, _ = start(killed).communicate(timeout=LIMIT)
    finished = judge(killed.folder, finished, lost)
    state = Path("results", "small", "growth.json")
    assert load_json(killed.folder / state) == load_json(whole.folder / state)
    assert [one["size"] for one in load_json(whole.folder / state)["history"]] == [10, 20, 30]
    lost["files unlike those of a whole run"] += len(unlike(whole.folder, killed.folder))
    LOST.update({f"growing study: {name}": count for name, count in lost.items()})
    assert finished
    assert sum(lost.values()) == 0, answer
