"""A run that was cut and goes on has the bytes of one that was not."""

import numpy as np
import pytest
from both_solvers import assert_same_bytes, both, solve
from cut_runs import CutShortError, assert_same, cut_after

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.solvers import pieces
from blockshake.solvers.checkpoint import Checkpoint

G = 9.81
# every law of friction, so that slips and impulses matter
LAWS = {"rate_drop": 0.2, "slip_drop": 0.3, "asymmetry": 0.1}
CHANGES = {"friction.concrete.concrete": 0.3} | {
    f"friction.concrete.concrete.{key}": value for key, value in LAWS.items()
}
TIME = np.linspace(0.0, 1.3, 1301)
# changes of configuration 1, motion, duration [s], parameters, steps of a piece
CUT = {
    "ls-dem": ({}, {"x": 0.6 * G * np.sin(6.0 * np.pi * TIME)}, 0.3, {}, 500),
    "nscd": (
        CHANGES, {"x": 4.0 * np.sin(9.0 * TIME), "y": 2.0 * np.cos(14.0 * TIME)}, 1.2,
        {"theta": 0.6, "impact_parts": 3}, 70,
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def run():
    """Run of a solver's case, with other parameters or a checkpoint."""

    def run(solver, **keys):
        changes, columns, duration, parameters, _ = CUT[solver]
        motion = ground_motion("sine", TIME, columns, "acceleration")
        return solve(
            solver, load_structure("configuration-1", changes), duration, motion, **parameters | keys
        )

    return run


@pytest.fixture(scope="module")
def whole(run):
    return {solver: run(solver) for solver in CUT}


@both
def test_a_cut_run_goes_on_bit_by_bit(solver, run, whole, tmp_path, monkeypatch):
    path, steps = tmp_path / "run.checkpoint", CUT[solver][-1]
    for savings in (5, 3):
        with monkeypatch.context() as patch:
            cut_after(patch, savings, steps)
            with pytest.raises(CutShortError):
                run(solver, checkpoint=path)
    assert path.exists()
    loaded, original = [], Checkpoint.load
    monkeypatch.setattr(Checkpoint, "load", lambda self: loaded.append(original(self)) or loaded[-1])
    resumed = run(solver, checkpoint=str(path))
    assert loaded[0][0].clock[0] >= 8 * steps  # it did read the checkpoint, of 5 + 3 pieces
    assert_same(whole[solver], resumed)
    assert not path.exists()
    # it rocked, so that springs, lists, impulses and faces mattered
    assert np.abs(whole[solver].orientation[:, 1:, 2]).max() > 1e-3


def test_steps_in_parts_and_slips_are_among_what_was_cut(whole):
    assert whole["nscd"].energy[-1, 3] > 100.0
    assert whole["nscd"].numerics["parted_steps"] > 0


def test_pauses_change_nothing(run, whole, monkeypatch):
    monkeypatch.setattr(pieces, "_FIRST_PIECE", 1)
    monkeypatch.setattr(pieces, "_next_piece", lambda steps, spent: steps)
    assert_same(whole["nscd"], run("nscd"))


def test_the_checkpoint_of_another_run_is_not_taken(run, tmp_path, monkeypatch):
    path = tmp_path / "run.checkpoint"
    with monkeypatch.context() as patch:
        cut_after(patch, 2, 500)
        with pytest.raises(CutShortError):
            run("ls-dem", checkpoint=path)
    softer = {"normal_stiffness": 2.0e10}
    assert_same(run("ls-dem", checkpoint=path, **softer), run("ls-dem", **softer))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut short", b"not a checkpoint"])
def test_a_checkpoint_that_cannot_be_read_starts_anew(content, run, whole, tmp_path):
    path = tmp_path / "run.checkpoint"
    path.write_bytes(content)
    assert_same(whole["ls-dem"], run("ls-dem", checkpoint=path))


def cubes(count, spacing, rise):
    """A row of cubes that fall one after the other, each from a gap of ``rise`` more than the one before [m]."""
    return [
        {
            "name": f"c{i}",
            "shape": "cube",
            "position": [spacing * (i - 0.5 * count), 0.0, 0.5 + rise * (i + 1)],
        }
        for i in range(count)
    ]


LONG = {"slab": {"box": [100.0, 3.0, 0.2]}}


def test_bodies_that_meet_late_find_room_in_the_lists_of_ls_dem(make_structure):
    """With short lists every landing is a new joint, with long ones none is."""
    structure = make_structure(cubes(24, 1.2, 0.001), shapes=LONG)
    late, early = (solve("ls-dem", structure, 0.1, skin=skin) for skin in (0.0005, 0.05))
    assert len(early.joints) == 24
    assert late.numerics["list_searches"] > early.numerics["list_searches"]
    assert_same_bytes(late, early)


def test_bodies_that_meet_late_find_room_in_the_record_of_nscd(make_structure):
    """Every landing is a new joint, and nothing before it."""
    run = solve("nscd", make_structure(cubes(40, 1.2, 0.0004), shapes=LONG), np.linspace(0.0, 0.3, 301))
    assert len(run.joints) == 40
    landed = np.sqrt(2.0 * 0.0004 * run.joints[:, 1] / G)
    for joint, instant in enumerate(landed):
        assert (run.joint_force[run.time < instant - 2e-3, joint] == 0.0).all()
    np.testing.assert_allclose(run.joint_force[-1, :, 2], 2400.0 * G, rtol=1e-6)
