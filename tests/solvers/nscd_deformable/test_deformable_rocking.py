"""Rocking: the rigid limit, the reduced block against the full mesh, and where the energy goes."""

import numpy as np
import pytest
from cut_runs import CutShortError, assert_same, cut_after
from cycle_of_sine import cycle

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.energy_residual import energy_residual
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import DeformableParameters, NscdParameters
from blockshake.solvers.nscd_deformable.driver import simulate_deformable

COARSE = {"mesh_size": 0.4, "contact_spacing": 0.8}


@pytest.fixture(scope="module")
def rocking(stone, tower):
    """Two blocks that rock under one cycle of 2 Hz."""
    return stone(tower(2)), cycle(4.0, 2.0, 3.0)


def test_stiff_blocks_move_like_rigid_ones(rocking, stone, tower, deform):
    """E times 1e4: the history of nscd-rigid with the same step until 1.5 s, within 2 % of the peak."""
    rigid_structure, motion = rocking
    structure = stone(tower(2), youngs_modulus=3.45e14)
    run = deform(structure, 1.5, motion=motion, **COARSE)
    rigid = simulate_nscd(rigid_structure, motion, NscdParameters(), run.time, 1e-3)
    assert run.status == rigid.status == "completed"
    way = rigid.position[:, 2, 0] - rigid.position[:, 0, 0]
    assert np.abs(way).max() > 0.02
    assert np.abs(run.position[:, 2] - rigid.position[:, 2]).max() < 0.02 * np.abs(way).max()


def _largest_difference(run, reference):
    """Largest difference of the upper block's histories over the largest way of the reference [1]."""
    way = reference.position[:, 2, 0] - reference.position[:, 0, 0]
    assert np.abs(way).max() > 0.02
    return np.abs(run.position[:, 2] - reference.position[:, 2]).max() / np.abs(way).max()


@pytest.mark.slow
@pytest.mark.parametrize("viscous", [False, True])
def test_the_reduced_block_moves_like_the_full_mesh(viscous, rocking, deform):
    """All nodes of the faces in contact: histories within 1 % of the peak for 1.5 s, six impacts."""
    structure, motion = rocking
    reduced, full = (
        deform(structure, 1.5, motion=motion, viscous=viscous, contact_spacing=0.2, modes=modes)
        for modes in (12, 10**9)
    )
    assert _largest_difference(reduced, full) < 0.01


@pytest.mark.slow
def test_fifteen_points_move_like_all_of_them(rocking, deform):
    """Viscoelastic, the default against 65 points a joint: within 2 % of the peak for 1.5 s."""
    structure, motion = rocking
    few, all_of_them = (
        deform(structure, 1.5, motion=motion, viscous=True, **keys) for keys in ({}, {"contact_spacing": 0.2})
    )
    assert _largest_difference(few, all_of_them) < 0.02


@pytest.mark.parametrize("viscous", [False, True])
def test_the_energy_audit_closes(viscous, rocking, deform):
    """Rocking with impacts: to 1e-4 of the energy in play; every dissipated term grows."""
    structure, motion = rocking
    run = deform(structure, 1.5, motion=motion, viscous=viscous, **COARSE)
    assert energy_residual(run.energy) < 1e-4
    assert np.diff(run.energy[:, 3:6], axis=0).min() >= 0.0
    assert run.energy[:, 2].min() > 0.0
    assert run.numerics["fraction_unconverged"] == 0.0


def test_a_block_that_is_turned_slowly_is_not_strained(stone, tower, deform):
    """A slab that pitches to 0.2 rad carries the block along: what it holds stays of the size of its weight's."""
    time = np.linspace(0.0, 2.0, 401)
    pitch = 0.2 * np.sin(np.pi * time / 2.0) ** 4
    motion = ground_motion("pitch", time, {"x": np.zeros(401), "pitch_y": pitch}, "displacement")
    structure = stone(tower(1, "cube", 1.0), friction=1.0)
    run = deform(structure, 2.0, motion=motion, **COARSE)
    held = run.energy[:, 2]
    assert held.max() < 3.0 * held[0]
    assert held[-1] == pytest.approx(held[0], rel=0.2)


def test_the_same_run_gives_the_same_bytes_also_when_it_is_cut(rocking, tmp_path, monkeypatch):
    """Stopped between two steps and gone on from its checkpoint."""
    structure, motion = rocking
    times, parameters = np.linspace(0.0, 0.6, 121), DeformableParameters(**COARSE)
    whole = simulate_deformable(structure, motion, parameters, times, 1e-3, viscous=True)
    path = tmp_path / "run.checkpoint"
    with monkeypatch.context() as patch:
        cut_after(patch, 1, 100)
        with pytest.raises(CutShortError):
            simulate_deformable(structure, motion, parameters, times, 1e-3, path, viscous=True)
    assert_same(whole, simulate_deformable(structure, motion, parameters, times, 1e-3, path, viscous=True))
    assert not path.exists()
