"""A run that was cut and goes on has the bytes of one that was not."""

import numpy as np
import pytest
from cut_runs import CutShortError, assert_same, cut_after

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.solvers.checkpoint import Checkpoint
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

G = 9.81
TIMES = np.arange(0.0, 0.3001, 0.005)


@pytest.fixture(scope="module")
def motion():
    time = np.arange(0.0, 0.3001, 0.001)
    return ground_motion("sine", time, {"x": 0.6 * G * np.sin(2 * np.pi * 3.0 * time)}, "acceleration")


def _run(motion, parameters=None, **keys):
    return simulate_ls_dem(
        load_structure("configuration-1"), motion, parameters or LsDemParameters(), TIMES, 5e-5, **keys
    )


@pytest.fixture(scope="module")
def whole(motion):
    return _run(motion)


def test_a_cut_run_goes_on_bit_by_bit(whole, motion, tmp_path, monkeypatch):
    path = tmp_path / "run.npz"
    for savings in (5, 3):
        with monkeypatch.context() as patch:
            cut_after(patch, savings, 500)
            with pytest.raises(CutShortError):
                _run(motion, checkpoint=path)
    assert path.exists()
    steps = []
    original = Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda self: steps.append(original(self)) or steps[-1])
    resumed = _run(motion, checkpoint=path)
    assert steps[0][0].clock[0] > 0  # it did read the checkpoint
    assert_same(whole, resumed)
    assert not path.exists()
    assert np.abs(whole.orientation[:, 1:, 2]).max() > 1e-3  # it rocked, so that springs and lists mattered


def test_the_checkpoint_of_another_run_is_not_taken(motion, tmp_path, monkeypatch):
    path = tmp_path / "run.npz"
    with monkeypatch.context() as patch:
        cut_after(patch, 2, 500)
        with pytest.raises(CutShortError):
            _run(motion, checkpoint=path)
    softer = LsDemParameters(normal_stiffness=2.0e10)
    assert_same(_run(motion, softer, checkpoint=path), _run(motion, softer))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut short", b"not a checkpoint"])
def test_a_checkpoint_that_cannot_be_read_starts_anew(content, whole, motion, tmp_path):
    path = tmp_path / "run.npz"
    path.write_bytes(content)
    assert_same(whole, _run(motion, checkpoint=path))


def test_bodies_that_meet_late_find_room_in_the_record(make_structure, run_ls_dem):
    """Cubes fall one after the other: with short lists every landing is a new joint, with long ones none is."""
    cubes = [
        {
            "name": f"c{index}",
            "shape": "cube",
            "position": [1.2 * index - 13.8, 0.0, 0.5 + 0.001 * (index + 1)],
        }
        for index in range(24)
    ]
    structure = make_structure(cubes, shapes={"slab": {"box": [32.0, 3.0, 0.2]}})
    late, early = (run_ls_dem(structure, 0.1, time_step=5e-5, skin=skin) for skin in (0.0005, 0.05))
    assert len(early.joints) == 24
    assert late.numerics["list_searches"] > early.numerics["list_searches"]
    for field in ("position", "joints", "joint_force"):
        assert getattr(late, field).tobytes() == getattr(early, field).tobytes(), field
