"""Shenton's (1996) chart of rest, slide, rock and slide-rock, by points 3 % off each of its boundaries."""

import numpy as np
import pytest
from both_solvers import both, leans, solve
from rocking_theory import H, Rocker
from shenton_theory import edge_of, hold, needed, points

OFF = 0.03  # from a boundary, of the number that is varied
ROCKERS = {"ls-dem": Rocker(0.0024), "nscd": Rocker(0.0)}
STEP = {"ls-dem": 2e-5, "nscd": 5e-4}
POINTS = {
    solver: {point[0]: point[1:] for point in points(rocker, OFF)} for solver, rocker in ROCKERS.items()
}
# LS-DEM: a joint under a thrust at its edge leans by 3.4e-4 rad, and swings to 4e-3 under a sliding block near tipping;
# rocking passes 1e-2 within the run
LEANS = 8e-3
# springs give micrometres, and the pivot's row 0.2 mm; sliding passes 2 mm
SLIDES = 1e-3


@both
def test_the_points_lie_in_the_regions_that_they_are_named_after(solver):
    """By the chart's own inequalities; all four regions."""
    rocker = ROCKERS[solver]
    slim = rocker.pivot / H
    for name, (mu, a, slides, rocks, _) in POINTS[solver].items():
        rest = a < min(mu, slim)
        slide = a > mu and mu < slim
        rock = a > slim and mu > needed(rocker, a)
        slide_rock = a > slim and slim < mu < needed(rocker, a)
        assert [rest, slide, rock, slide_rock].count(True) == 1, name
        assert (slides, rocks) == (slide or slide_rock, rock or slide_rock), name
    assert len({(slides, rocks) for _, _, slides, rocks, _ in POINTS[solver].values()}) == 4


@both
@pytest.mark.parametrize("point", POINTS["nscd"])
def test_the_chart(point, solver, make_structure):
    mu, a, slides, rocks, duration = POINTS[solver][point]
    structure = make_structure([{"name": "b", "shape": "sharp", "position": [0.0, 0.0, H]}], friction=mu)
    # the base stops dead after its last row
    motion = hold(a, slides, rocks, duration + 0.01)
    run = solve(solver, structure, duration, motion, STEP[solver])
    lean = leans(run)
    edge = edge_of(run, ROCKERS[solver], lean)
    assert (np.abs(lean).max() > LEANS) == rocks
    assert (np.abs(edge - edge[0]).max() > SLIDES) == slides
    if solver == "nscd":
        # a rigid block that does not rock does not lean at all, but for rounding; of an edge that turns without slip,
        # w^2 r dt^2 / 2 a step
        assert rocks or np.abs(lean).max() < 1e-7
        assert slides or np.abs(edge - edge[0]).max() < 1e-5
