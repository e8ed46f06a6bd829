"""Run files and checkpoints with mutations: read, refused in one line, or made anew."""

import json
from pathlib import Path

import numpy as np
import pytest
from contract import read_or_refused, run_command, scratch
from good_campaign import netcdf
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_bytes, mutated_datasets, mutated_mappings, mutations
from test_fuzz_structures import GOOD

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import build_structure
from blockshake.simulation.simulate import simulate
from blockshake.solvers.checkpoint import load_parts, save_parts

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

COMMANDS = (
    ("export", "r.nc", "--output", "o.csv"), ("export", "r.nc", "--output", "o.vtkhdf"),
    ("export", "r.nc", "--output", "o.glb"), ("plot", "r.nc", "--output", "o.png"),
)  # fmt: skip
PARTS = {
    "state": (np.arange(12.0).reshape(4, 3), np.ones(4, bool)),
    "progress": (np.array(3), np.array(0.5)),
    "none": (),
}


@pytest.fixture(scope="session")
def run():
    """A run of two blocks for a moment."""
    return made_run()


def made_run():
    """A run of two blocks for a moment."""
    time = np.linspace(0.0, 0.5, 51)
    motion = ground_motion("sine", time, {"x": np.sin(12.0 * time)}, "acceleration")
    return simulate(build_structure(GOOD, "s.yaml", "."), motion, "nscd-rigid", duration=0.2)


@st.composite
def damaged_runs(draw, run):
    """Bytes of a run file: of a changed Dataset, of another structure in its attribute, or changed themselves."""
    what = draw(st.sampled_from(("dataset", "structure", "bytes")))
    if what == "bytes":
        return draw(mutated_bytes(netcdf(run)))
    if what == "structure":
        mapping = draw(mutated_mappings(json.loads(run.attrs["structure_file"])))
        changed = run.assign_attrs(structure_file=json.dumps(mapping, default=str, skipkeys=True))
    else:
        changed = draw(mutated_datasets(run))
    try:
        return netcdf(changed)
    except (TypeError, ValueError, KeyError, RuntimeError, AttributeError, UnicodeError):
        return b""  # the format itself has no place for the change


def looked_at(content, command):
    """Exit code of a command on a run file with this content."""
    with scratch() as folder:
        Path(folder, "r.nc").write_bytes(content)
        code = run_command(command, folder)[0]
        made = {path.name for path in Path(folder).iterdir()} - {"r.nc"}
        assert made == set() or code == 0
        return code


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_a_good_run_is_read(run, command):
    assert looked_at(netcdf(run), command) == 0


@mutations(FEW)
@given(st.data())
def test_mutated_runs(run, data):
    looked_at(data.draw(damaged_runs(run)), data.draw(st.sampled_from(COMMANDS[:4])))


@pytest.mark.slow
@mutations(MANY)
@given(st.data())
def test_many_mutated_runs(run, data):
    looked_at(data.draw(damaged_runs(run)), data.draw(st.sampled_from(COMMANDS)))


def saved():
    """Bytes of a checkpoint."""
    with scratch() as folder:
        save_parts(f"{folder}/c", "the key", PARTS)
        return Path(folder, "c").read_bytes()


def loaded(content):
    """Whether a checkpoint with this content is taken: then it is whole."""
    found = []
    with scratch() as folder:
        Path(folder, "c").write_bytes(content)
        read_or_refused(lambda: found.append(load_parts(f"{folder}/c", "the key")), folder)
    if found[0] is None:
        return False
    for name in ("state", "progress"):
        for kept, part in zip(found[0][name], PARTS[name], strict=True):
            np.testing.assert_array_equal(kept, part)
    return True


def test_a_good_checkpoint_is_read():
    assert loaded(saved())


@mutations(FEW)
@given(mutated_bytes(saved()))
def test_mutated_checkpoints(content):
    loaded(content)


@pytest.mark.slow
@mutations(MANY)
@given(mutated_bytes(saved()))
def test_many_mutated_checkpoints(content):
    loaded(content)
