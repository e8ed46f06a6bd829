"""A block that rocks alone after a kick, against the theory of rigid rocking."""

import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.parameters import NscdParameters

G = 9.81


@pytest.fixture
def kicked_block(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import kicked_block

    yield kicked_block
    sys.modules.pop("kicked_block")


def test_swing_and_impact_are_those_of_a_rigid_block(kicked_block):
    """Rigid rocking: energy gives the time of the swing, a quadrature; the impact lies between Housner's and none.

    The kick is one about the block's edge; the pivot is the outermost node, 22 mm inside. There the kick's angular
    momentum about it is kept, so that the block starts 0.9 % faster.
    """
    parameters = LsDemParameters()
    read = kicked_block.rocking_block(load_structure("configuration-1"), "ls-dem", parameters, 2e-5, 1.0)
    half, edge = 0.8, 0.4
    pivot = (edge - 0.02) * (1.0 - 2.0 * parameters.perimeter_inset)
    central, radius = (0.8**2 + 1.6**2) / 12.0, np.hypot(half, pivot)
    inertia, alpha = central + radius**2, np.arctan(pivot / half)  # of a unit mass
    p2 = G * radius / inertia
    speed = 0.5 * (central + half**2 + edge * pivot) / inertia
    turned = alpha - np.arccos(np.cos(alpha) + speed**2 / (2.0 * p2))
    # theta = turned (1 - s^2) takes the root out of the turning point
    s = (np.arange(4000) + 0.5) / 4000
    left = speed**2 - 2.0 * p2 * (np.cos(alpha - turned * (1.0 - s**2)) - np.cos(alpha))
    expected = 2.0 * np.mean(2.0 * turned * s / np.sqrt(left))
    # without its chamfers' corners the block has 0.1 % less inertia than the sharp one
    assert read["swing_time"] == pytest.approx(expected, rel=2e-3)
    assert 1.0 - 2.0 * pivot**2 / inertia < read["impact_ratio"] < 1.0


def test_block_without_a_base_is_refused(kicked_block, make_structure):
    flying = make_structure([{"name": "b", "shape": "cube", "position": [0.0, 0.0, 2.0]}])
    with pytest.raises(InputError, match="stands on a driven one"):
        kicked_block.rocking_block(flying, "ls-dem", LsDemParameters(), 1e-4, 1.0)


def test_housners_ratio_is_that_of_the_flat_of_a_block(kicked_block):
    """Housner (1963) for a base of 0.76 m between chamfers; the chamfer takes 0.1 % of mass and inertia."""
    pivot, half = 0.38, 0.8
    about_edge = (0.8**2 + 1.6**2) / 12.0 + pivot**2 + half**2
    expected = 1.0 - 2.0 * pivot**2 / about_edge
    assert kicked_block.housner_ratio(load_structure("configuration-1")) == pytest.approx(expected, rel=1e-3)


def test_a_rigid_block_on_corners_keeps_what_housner_says(kicked_block):
    """Impacts are placed to a part of the step: half a per cent of the ratio, less at half the step."""
    structure, parameters = load_structure("configuration-1"), NscdParameters(impact_parts=20)
    usual, half = (
        kicked_block.rocking_block(structure, "nscd-rigid", parameters, step, 1.0)["impact_ratio"]
        for step in (1e-3, 5e-4)
    )
    error, finer = (abs(ratio / kicked_block.housner_ratio(structure) - 1.0) for ratio in (usual, half))
    assert finer < error < 5e-3
