"""Shenton's (1996) chart of rest, slide, rock and slide-rock, by points 3 % off each of its boundaries."""

import numpy as np
import pytest
from rocking_theory import H, Rocker, leans
from shenton_theory import edge_of, hold, needed, points

ROCKER = Rocker(0.0024)
SLIM = ROCKER.pivot / H
OFF = 0.03  # from a boundary, of the number that is varied
# A joint under a thrust at its edge leans by 3.4e-4 rad, and swings to 4e-3 under a sliding block near tipping;
# rocking passes 1e-2 within the run
LEANS = 8e-3
# springs give micrometres, and the pivot's row 0.2 mm; sliding passes 2 mm
SLIDES = 1e-3


POINTS = list(points(ROCKER, OFF))


def test_the_points_lie_in_the_regions_that_they_are_named_after():
    """By the chart's own inequalities; all four regions."""
    for name, mu, a, slides, rocks, _ in POINTS:
        rest = a < min(mu, SLIM)
        slide = a > mu and mu < SLIM
        rock = a > SLIM and mu > needed(ROCKER, a)
        slide_rock = a > SLIM and SLIM < mu < needed(ROCKER, a)
        assert [rest, slide, rock, slide_rock].count(True) == 1, name
        assert (slides, rocks) == (slide or slide_rock, rock or slide_rock), name
    assert len({(slides, rocks) for _, _, _, slides, rocks, _ in POINTS}) == 4


@pytest.mark.parametrize(
    ("mu", "a", "slides", "rocks", "duration"), [p[1:] for p in POINTS], ids=[p[0] for p in POINTS]
)
def test_the_chart(mu, a, slides, rocks, duration, make_structure, run_ls_dem):
    structure = make_structure([{"name": "b", "shape": "sharp", "position": [0.0, 0.0, H]}], friction=mu)
    run = run_ls_dem(structure, duration, motion=hold(a, slides, rocks, duration), time_step=2e-5)
    lean = leans(run)
    edge = edge_of(run, ROCKER, lean)
    assert (np.abs(lean).max() > LEANS) == rocks
    assert (np.abs(edge - edge[0]).max() > SLIDES) == slides
