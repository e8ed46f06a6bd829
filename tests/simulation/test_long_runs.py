"""Run files written part by part: the same bytes as a run in memory, in memory that hardly grows with the duration."""

import json
import shutil
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
import yaml

from blockshake.dynamics.motion import ground_motion
from blockshake.files import load_yaml, shipped, write_dataset
from blockshake.simulation.simulate import simulate, simulate_to_file
from blockshake.solvers import pieces
from blockshake.solvers.checkpoint import Checkpoint, KeptRows

TIME = np.linspace(0.0, 1.0, 201)
# a pulse that overturns the stack within the second, and one that does not
SHAKES = {
    "falls": ground_motion("push", TIME, {"x": 12.0 * (TIME < 0.6)}, "acceleration"),
    "stands": ground_motion("shake", TIME, {"x": 2.0 * np.sin(15.0 * TIME)}, "acceleration"),
}
STEP = {"ls-dem": 2e-4, "nscd-rigid": 1e-3}
DURATION = 2.5  # s
_PER_SECOND = 0.5  # MiB; a run in memory takes ten times as much a second of motion


class _CutError(Exception):
    """Ends a run in the middle."""


@pytest.fixture
def few_rows_at_hand(monkeypatch):
    """Windows of some 0.14 s of motion, so that short runs have many."""
    monkeypatch.setattr(pieces, "AT_HAND", 300)


def _assert_same_file(path, run, folder):
    """The variables, their descriptions and the attributes of a run file are those of a run in memory, to the bit."""
    write_dataset(folder / "memory.nc", run)
    found, expected = (xr.load_dataset(one, decode_times=False) for one in (path, folder / "memory.nc"))
    assert found.attrs == expected.attrs
    assert list(found.data_vars) == list(expected.data_vars)
    assert set(found.coords) == set(expected.coords)
    for name, variable in expected.variables.items():
        assert (found[name].dims, found[name].dtype, found[name].attrs) == (
            variable.dims, variable.dtype, variable.attrs,
        ), name  # fmt: skip
        if variable.dtype.kind == "f":
            assert found[name].to_numpy().tobytes() == variable.to_numpy().tobytes(), name
        else:
            assert found[name].values.tolist() == variable.values.tolist(), name


@pytest.mark.parametrize("shake", sorted(SHAKES))
@pytest.mark.parametrize("model", sorted(STEP))
def test_a_run_file_is_the_run_in_memory_to_the_bit(model, shake, few_rows_at_hand, tmp_path):
    arguments = "configuration-1", SHAKES[shake], model
    run = simulate(*arguments, time_step=STEP[model], duration=DURATION)
    assert (run.attrs["status"] == "collapsed") == (shake == "falls")
    simulate_to_file(tmp_path / "run.nc", *arguments, time_step=STEP[model], duration=DURATION)
    _assert_same_file(tmp_path / "run.nc", run, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["memory.nc", "run.nc"]


@pytest.mark.parametrize("accelerometers", [True, False])
def test_transducers_read_the_same_part_by_part(accelerometers, few_rows_at_hand, tmp_path):
    mapping = load_yaml(shipped("structures", "configuration-1"))
    mapping["displacement_transducers"] = [
        {"name": "wire", "body": "block-3", "position": [-0.4, 0.0, 0.0], "reference": "slab",
         "reference_position": [-1.5, 0.0, 0.1]},
    ]  # fmt: skip
    if not accelerometers:
        del mapping["accelerometers"]
    path = tmp_path / "wired.yaml"
    path.write_text(yaml.safe_dump(mapping))
    for shake in SHAKES.values():
        arguments = path, shake, "nscd-rigid"
        run = simulate(*arguments, time_step=STEP["nscd-rigid"], duration=DURATION)
        assert float(np.abs(run["transducer_displacement"]).max()) > 1e-3
        simulate_to_file(tmp_path / "run.nc", *arguments, time_step=STEP["nscd-rigid"], duration=DURATION)
        _assert_same_file(tmp_path / "run.nc", run, tmp_path)


@pytest.mark.parametrize("model", sorted(STEP))
def test_a_run_that_was_cut_goes_on_to_the_same_bits(model, few_rows_at_hand, tmp_path, monkeypatch):
    arguments = "configuration-1", SHAKES["stands"], model
    path, put, save = tmp_path / "run.nc", KeptRows.put, Checkpoint.save
    saved, loaded = [], []

    def cut_after_some(kept, first, rows):
        put(kept, first, rows)
        if len(list((tmp_path / "run.nc.checkpoint.rows").iterdir())) > 4:
            raise _CutError

    def often(checkpoint, parts):
        save(checkpoint, parts)
        saved.append(int(parts[-1].first[0]))

    monkeypatch.setattr(Checkpoint, "save", often)
    monkeypatch.setattr(pieces.Due, "__call__", lambda due: len(saved) < 12)
    monkeypatch.setattr(pieces, "_next_piece", lambda steps, spent: 150)
    monkeypatch.setattr(KeptRows, "put", cut_after_some)
    with pytest.raises(_CutError):
        simulate_to_file(path, *arguments, time_step=STEP[model], duration=DURATION)
    assert not path.exists()
    reached = saved[-1]
    assert reached > 0
    shutil.copy(f"{path}.checkpoint", tmp_path / "copy.checkpoint")
    load = Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda saving: loaded.append(load(saving)) or loaded[-1])
    monkeypatch.setattr(KeptRows, "put", put)
    simulate_to_file(path, *arguments, time_step=STEP[model], duration=DURATION)
    assert int(loaded[0][-1].first[0]) == reached  # it did go on, with rows from before
    # a run in memory has no such rows, and starts anew
    run = simulate(
        *arguments, time_step=STEP[model], duration=DURATION, checkpoint=tmp_path / "copy.checkpoint"
    )
    _assert_same_file(path, run, tmp_path)


def test_kept_rows_serve_their_own_run_alone_and_only_when_all_are_there(tmp_path):
    def rows(count):
        return type("Rows", (), {"time": np.zeros(count)})

    kept = KeptRows(tmp_path / "rows", lambda rows: {"time": (rows.time,)})
    kept.begin("key")
    kept.put(0, rows(5))
    kept.put(5, rows(3))
    kept.put(8, rows(2))
    assert kept.goes_on("key", 10)
    assert [len(part["time"][0]) for part in kept.read("time")] == [5, 3, 2]
    # a checkpoint from before the last rows: they are made anew
    assert kept.goes_on("key", 8)
    assert sorted(path.stem for path in (tmp_path / "rows").iterdir()) == ["000000000000", "000000000005"]
    assert not kept.goes_on("key", 10)
    assert not kept.goes_on("another key", 8)
    (tmp_path / "rows" / "000000000000.npz").write_bytes(b"cut short")
    assert not kept.goes_on("key", 8)
    kept.begin("key")
    assert not (tmp_path / "rows").exists()


_PROGRAM = """
import json, resource, sys
from blockshake.dynamics.load_motion import load_motion
from blockshake.simulation.simulate import simulate_to_file
shake, peaks = load_motion("basso-tirreno"), []
for duration in map(float, sys.argv[2:]):
    simulate_to_file(sys.argv[1], "configuration-1", shake, "nscd-rigid", duration=duration)
    peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
print(json.dumps(peaks))
"""


def test_the_memory_of_a_long_run_hardly_grows(tmp_path):
    """A minute and a half more of configuration 1, with accelerometers: 470 MiB where all is in memory."""
    short, long = 20.0, 110.0
    command = [sys.executable, "-c", _PROGRAM, tmp_path / "run.nc", str(short), str(long)]
    peaks = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert peaks[1] - peaks[0] < _PER_SECOND * (long - short)
