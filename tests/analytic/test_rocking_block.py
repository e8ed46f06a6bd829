"""One block that rocks on LS-DEM's springs: its onset, its quarter period, and that it stays in its plane."""

import numpy as np
import pytest
from both_solvers import leans
from rocking_theory import HALF_WIDTH, G, H, Rocker
from scipy.optimize import brentq

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.surface_nodes import line_nodes

INSET = 0.003 * 2.0 * HALF_WIDTH  # m; the outermost nodes, and so the pivot, lie this far inside the edge
ROCKER = Rocker(INSET)
# Lean of a block whose weight rests on its last row of nodes, rad, from `_static_lean`
ELASTIC_LEAN = 8.35e-5


def _static_lean(acceleration):
    """Lean under a steady base acceleration: two equations of statics on one-sided rows of springs.

    The rows are the block's own nodes; the resultant lies where the thrust line meets the base, moved by the lean
    itself.
    """
    x, width = line_nodes(2.0 * HALF_WIDTH, 0.2, INSET)
    stiffness = 2.16e10 * 2.4 * width

    def forces(depth, lean):
        return stiffness * np.maximum(depth + lean * x, 0.0) / (ROCKER.mass * G)

    def moment(lean):
        depth = brentq(lambda depth: forces(depth, lean).sum() - 1.0, -lean * HALF_WIDTH, 1e-3)
        return forces(depth, lean) @ x - H * (acceleration / G + lean)

    return brentq(moment, 0.0, 1e-3)


@pytest.mark.parametrize(("part", "rocks"), [(0.99, False), (1.01, True)])
def test_rocking_sets_in_at_housners_acceleration(part, rocks, make_structure, run_ls_dem):
    """Housner (1963): a > g b/h, with the pivot at the perimeter nodes; reached gently, without a jerk."""
    time = np.arange(0.0, 1.8001, 0.01)
    a = part * G * ROCKER.pivot / H * 0.5 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0)))
    motion = ground_motion("ramp", time, {"x": a}, "acceleration")
    structure = make_structure([{"name": "b", "shape": "sharp", "position": [0.0, 0.0, H]}], friction=0.9)
    run = run_ls_dem(structure, 1.8, motion=motion, rate=50)
    lean = np.abs(leans(run)).max()
    # above, 1 % of excess grows with p = 2.9 1/s: 0.01 alpha (cosh(p 0.8 s) - 1) = 0.02 rad;
    # below, the springs' lean alone and some of its swing
    assert (lean > 0.01) == rocks
    if not rocks:
        static = _static_lean(a[-1])
        assert static == pytest.approx(ELASTIC_LEAN, rel=0.05)
        assert lean == pytest.approx(static, rel=0.25)
    # the base accelerates to +x, the block leans to -x
    assert leans(run)[-1] < 0.0


@pytest.mark.parametrize("angle", [0.05, 0.15])
def test_the_quarter_period_of_rocking(angle, make_structure, run_ls_dem):
    """Housner (1963): I0 theta'' = -m g R sin(alpha - theta) from release to the first impact."""
    quarter = ROCKER.quarter(angle)
    # Housner's formula, linear in the angles: 3 % of alpha^2 / 6 apart from the exact one
    linear = np.arccosh(1.0 / (1.0 - angle / ROCKER.alpha)) / np.sqrt(ROCKER.p2)
    assert linear == pytest.approx(quarter, rel=0.03)
    run = run_ls_dem(make_structure([ROCKER.body(angle)], friction=0.9), 0.6, rate=2000)
    lean = leans(run)
    after = np.flatnonzero(lean < 0.0)[0]
    found = np.interp(0.0, [lean[after], lean[after - 1]], [run.time[after], run.time[after - 1]])
    # the pivot gives way by ELASTIC_LEAN, which brings the impact forward or back by that over the speed
    assert found == pytest.approx(quarter, abs=ELASTIC_LEAN / ROCKER.speed(0.0, angle))


def test_the_pivot_holds_and_the_block_neither_slides_nor_turns_away(make_structure, run_ls_dem):
    """The set-up is symmetric about y, and so is the answer, to rounding."""
    run = run_ls_dem(make_structure([ROCKER.body(0.1)], friction=0.9), 1.5)
    assert np.abs(run.position[:, 1, 1]).max() < 1e-9
    assert np.abs(run.orientation[:, 1, [1, 3]]).max() < 1e-9
