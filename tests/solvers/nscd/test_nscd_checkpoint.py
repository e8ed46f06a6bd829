"""A run that was cut and goes on has the bytes of one that was not."""

import numpy as np
import pytest
from cut_runs import CutShortError, assert_same, cut_after

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.solvers import pieces
from blockshake.solvers.checkpoint import Checkpoint
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

TIMES = np.arange(0.0, 1.2001, 0.005)


@pytest.fixture(scope="module")
def structure():
    """The blocks of configuration 1 with every law of friction, so that slips and impulses matter."""
    laws = {"rate_drop": 0.2, "slip_drop": 0.3, "asymmetry": 0.1}
    return load_structure(
        "configuration-1",
        {"friction.concrete.concrete": 0.3}
        | {f"friction.concrete.concrete.{key}": value for key, value in laws.items()},
    )


@pytest.fixture(scope="module")
def motion():
    time = np.linspace(0.0, 1.3, 261)
    return ground_motion(
        "sine", time, {"x": 4.0 * np.sin(9.0 * time), "y": 2.0 * np.cos(14.0 * time)}, "acceleration"
    )


def _run(structure, motion, **keys):
    return simulate_nscd(structure, motion, NscdParameters(theta=0.6, impact_parts=3), TIMES, 1e-3, **keys)


@pytest.fixture(scope="module")
def whole(structure, motion):
    return _run(structure, motion)


def test_a_cut_run_goes_on_bit_by_bit(structure, whole, motion, tmp_path, monkeypatch):
    path = tmp_path / "run.checkpoint"
    for savings in (5, 3):
        with monkeypatch.context() as patch:
            cut_after(patch, savings, 70)
            with pytest.raises(CutShortError):
                _run(structure, motion, checkpoint=path)
    assert path.exists()
    steps = []
    original = Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda self: steps.append(original(self)) or steps[-1])
    resumed = _run(structure, motion, checkpoint=str(path))
    # it did read the checkpoint, of 5 + 3 pieces
    assert steps[0][0].clock[0] >= 560
    assert_same(whole, resumed)
    assert not path.exists()
    # it rocked and slid, so that impulses, faces and slips mattered
    assert np.abs(whole.orientation[:, 1:, 2]).max() > 1e-3
    assert whole.energy[-1, 3] > 100.0
    assert whole.numerics["parted_steps"] > 0


def test_pauses_change_nothing(structure, whole, motion, monkeypatch):
    monkeypatch.setattr(pieces, "_FIRST_PIECE", 1)
    monkeypatch.setattr(pieces, "_next_piece", lambda steps, spent: steps)
    assert_same(whole, _run(structure, motion))


def test_bodies_that_meet_late_find_room_in_the_record(scene, simulate):
    """A row of forty cubes falls one after the other: every landing is a new joint, nothing before it."""
    cubes = [
        {"name": f"c{index}", "shape": "cube", "position": [1.0 * index, 0.0, 0.25 + 0.0004 * (index + 1)]}
        for index in range(40)
    ]
    shapes = {"cube": {"box": [0.5, 0.5, 0.5]}, "floor": {"box": [100.0, 3.0, 0.2]}}
    run = simulate(scene(shapes, cubes), 0.3, output_step=1e-3)
    assert len(run.joints) == 40
    weight = 0.5**3 * 2400.0 * 9.81
    landed = np.sqrt(2.0 * 0.0004 * run.joints[:, 1] / 9.81)
    for joint, instant in enumerate(landed):
        assert (run.joint_force[run.time < instant - 2e-3, joint] == 0.0).all()
    np.testing.assert_allclose(run.joint_force[-1, :, 2], weight, rtol=1e-6)
