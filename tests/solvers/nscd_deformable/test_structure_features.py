"""Soft joints, eccentric masses and stoppers act on deformable blocks through the structure, as on rigid ones."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.energy_residual import energy_residual
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

COARSE = {"mesh_size": 0.4, "contact_spacing": 0.8, "modes": 6}
G = 9.81


def _shake(acceleration, until):
    time = np.linspace(0.0, until, 301)
    return ground_motion("shake", time, {"x": acceleration * np.sin(8.0 * np.pi * time)}, "acceleration")


def test_a_soft_joint_sinks_by_its_compliance(stone, tower, deform):
    """Pressure times compliance, besides the block's own shortening, to 1 %."""
    compliance = 2e-10
    joints = [{"bodies": ["slab", "block-1"], "compliance": compliance}]
    soft, hard = (stone(tower(1), joints=listed) for listed in (joints, []))
    heights = [deform(one, 0.01, **COARSE).position[-1, 1, 2] for one in (soft, hard)]
    pressure = soft.mass[1] * G / (0.8 * 2.4)
    assert heights[1] - heights[0] == pytest.approx(pressure * compliance, rel=0.01)


def test_an_eccentric_mass_leans_on_its_side(stone, tower, deform):
    """The mass centre 0.1 m aside: the joint's force is the weight, and the block rests."""
    bodies = tower(1)
    bodies[0]["mass_offset"] = [0.1, 0.0, 0.0]
    structure = stone(bodies)
    run = deform(structure, 0.05, **COARSE)
    assert run.joint_force[-1, 0] == pytest.approx(
        [0.0, 0.0, structure.mass[1] * G], abs=1e-3 * structure.mass[1]
    )
    assert np.abs(run.angular_velocity[-1]).max() < 1e-9


def test_a_stop_takes_a_block_that_slides(stone, tower, deform):
    """On a floor without friction the stop alone carries the block along: as nscd-rigid, within 2 % of the way."""
    stoppers = [
        {"body": "block-1", "position": [side * 0.4, 0.0, 0.0], "axis": axis, "gap": 0.005, "stiffness": 1e7}
        for side, axis in ((1.0, "+x"), (-1.0, "-x"))
    ]
    structure = stone(tower(1), friction=0.0, stoppers=stoppers)
    motion = _shake(2.0, 0.5)
    run = deform(structure, 0.5, motion=motion, **COARSE)
    rigid = simulate_nscd(structure, motion, NscdParameters(), run.time, 1e-3)
    way = np.abs(rigid.position[:, 1, 0] - rigid.position[:, 0, 0]).max()
    assert way > 0.005
    assert np.abs(run.position[:, 1, 0] - rigid.position[:, 1, 0]).max() < 0.02 * way
    assert energy_residual(run.energy) < 1e-3
