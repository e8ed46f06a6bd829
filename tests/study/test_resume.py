"""A killed simulation goes on where it was and writes the run file of one that was not killed."""

import os
import re
import resource
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import psutil
import pytest
import xarray as xr
from checkout import heed_interrupts
from cut_runs import CutShortError

from blockshake.dynamics.load_motion import load_motion
from blockshake.simulation.models import MODELS
from blockshake.simulation.simulate import simulate
from blockshake.solvers import pieces
from blockshake.solvers.checkpoint import Checkpoint
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns, simulate_samples

# seconds of motion that take some seconds of wall time
LONG = {"ls-dem": 12.0, "nscd-rigid": 40.0}
# CPU s from an interrupt to the end of the process: a piece of at most half a second, and saving
MOST_WORK = 2.0
ARRAYS = (
    "position", "orientation", "velocity", "angular_velocity", "marker_displacement", "energy", "joint_force",
)  # fmt: skip

# the command line, saving every tenth of a second
SIMULATE = """
import sys
from blockshake.cli import main
from blockshake.solvers import pieces
Due = pieces.Due
pieces.Due = lambda interval: Due(0.1)
sys.exit(main(sys.argv[1:]))
"""


def _command(model, output):
    return [
        sys.executable, "-c", SIMULATE,
        "simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", model, "--output-rate", "50",
        "--duration", str(LONG[model]), "--output", str(output), *(["--time-step", "5e-5"] * (model == "ls-dem")),
    ]  # fmt: skip


def _work_of_children():
    """CPU time of the processes that were started here and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _assert_same(one, other):
    for name in ARRAYS:
        assert one[name].values.tobytes() == other[name].values.tobytes(), name
    assert {key: value for key, value in one.attrs.items() if key != "history"} == {
        key: value for key, value in other.attrs.items() if key != "history"
    }


# one model for each signal: tests/solvers/test_interrupts.py interrupts every model
@pytest.mark.parametrize(("model", "end"), [("ls-dem", signal.SIGKILL), ("nscd-rigid", signal.SIGINT)])
def test_a_killed_or_interrupted_command_goes_on(model, end, tmp_path):
    output, checkpoint = tmp_path / "run.nc", tmp_path / "run.nc.checkpoint"
    killed = subprocess.Popen(
        _command(model, output), stderr=subprocess.PIPE, text=True, preexec_fn=heed_interrupts
    )
    deadline = time.monotonic() + 300.0
    while not checkpoint.exists() and killed.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    before, own = _work_of_children(), psutil.Process(killed.pid).cpu_times()
    os.kill(killed.pid, end)
    _, said = killed.communicate()
    if end == signal.SIGINT:
        # the work is requested, not the time, which on a busy machine states nothing
        assert _work_of_children() - before - (own.user + own.system) < MOST_WORK
        assert killed.returncode == 130
        assert re.fullmatch(
            rf"blockshake: interrupted at [0-9.]+ s; the same command goes on from {checkpoint}",
            said.splitlines()[-1],
        )
        assert "Traceback" not in said
    else:
        assert killed.returncode == -signal.SIGKILL
    assert checkpoint.exists()
    assert not output.exists()
    again = subprocess.run(_command(model, output), capture_output=True, text=True, check=True)
    # it states it, and from where: neither the start nor the end
    reached = float(re.search(r"goes on from ([0-9.]+) s", again.stderr)[1])
    assert 0.0 < reached < LONG[model]
    assert not checkpoint.exists()
    whole = simulate(
        "configuration-1", "alkion", model, time_step=5e-5 if model == "ls-dem" else None, duration=LONG[model],
        output_rate=50.0,
    )  # fmt: skip
    _assert_same(xr.load_dataset(output), whole)


@pytest.mark.parametrize("model", sorted(MODELS))
def test_a_killed_sample_goes_on_in_the_store(model, tmp_path, monkeypatch):
    """The second attempt starts from the checkpoint with where the sample goes, and leaves none behind."""
    case = {"structure": "configuration-1", "duration": 1.0}
    motion = load_motion("alkion")
    rows = pd.DataFrame({"friction.concrete.concrete": [0.6]}, index=[3])
    step = 5e-5 if model == "ls-dem" else 1e-3

    def attempt(store):
        runs = CaseRuns(case, model, {"time_step": step}, {}, 50.0)
        return simulate_samples(runs, lambda sample, row: motion, rows, Store(store, "source"))

    (whole,) = attempt(tmp_path / "whole")

    def save_and_die(checkpoint, parts):
        save(checkpoint, parts)
        raise CutShortError

    save, load = Checkpoint.save, Checkpoint.load
    with monkeypatch.context() as patch:
        patch.setattr(pieces, "Due", lambda interval: lambda: True)
        patch.setattr(Checkpoint, "save", save_and_die)
        with pytest.raises(CutShortError):
            attempt(tmp_path / "cut")
    assert [path.suffix for path in (tmp_path / "cut").iterdir()] == [".checkpoint"]
    loaded = []
    monkeypatch.setattr(Checkpoint, "load", lambda self: loaded.append(load(self)) or loaded[-1])
    (resumed,) = attempt(tmp_path / "cut")
    assert loaded[0] is not None
    assert list((tmp_path / "cut").iterdir()) == [resumed]
    one, other = xr.load_dataset(whole), xr.load_dataset(resumed)
    for name in one.data_vars:
        np.testing.assert_array_equal(one[name].values, other[name].values, err_msg=name)
