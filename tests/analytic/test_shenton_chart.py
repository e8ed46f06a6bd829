"""Shenton's (1996) chart of rest, slide, rock and slide-rock, by points 3 % off each of its boundaries.

Criteria for initiation of slide, rock, and slide-rock rigid-body modes, J. Eng. Mech. 122(7). Base acceleration
``a`` in g and friction ``mu`` of a block of ``b/h``: rest below both; slide where ``mu < b/h``; with ``mu > b/h``
and ``a > b/h`` rock without slip asks for ``mu_needed(a)``; slide-rock between ``b/h`` and that.
"""

import numpy as np
import pytest
from rocking_theory import G, H, Rocker, leans

from blockshake.dynamics.motion import ground_motion

ROCKER = Rocker(0.005)
SLIM = ROCKER.pivot / H
OFF = 0.03  # from a boundary, of the number that is varied
# A joint under a thrust at its edge leans by 3.4e-4 rad, and swings to 4e-3 under a sliding block near tipping;
# rocking passes 1e-2 within the run
LEANS = 8e-3
# springs give micrometres, and the pivot's row 0.2 mm; sliding passes 2 mm
SLIDES = 1e-3


def _needed(a):
    """Friction that holds the pivot as rocking sets in under ``a``, from rest.

    About the pivot ``I q = m (a h - g b)``; there the base gives ``a - h q`` across and ``g + b q`` up.
    """
    q = ROCKER.mass * (a * H - ROCKER.pivot) / ROCKER.inertia
    return (a - H * q) / (1.0 + ROCKER.pivot * q)


def _points():
    low, high = 1.0 - OFF, 1.0 + OFF
    # the boundary of rest: a = mu under b/h, and a = b/h over it
    for mu in (0.15, 0.3, 0.45):
        yield f"rest-{mu}", mu, low * mu, False, False, 0.5
        yield f"slide-{mu}", mu, high * mu, True, False, 0.5
    for mu in (0.6, 0.9):
        yield f"rest-{mu}", mu, low * SLIM, False, False, 0.6
        yield f"rock-{mu}", mu, high * SLIM, False, True, 0.6
    # the wedge of slide-rock between mu = b/h and mu = needed(a), from its tip at a = b/h on; a wedge narrower
    # than two margins, as at 0.55 g, has no point inside it
    for a in (0.7, 0.9, 1.2):
        yield f"slide-under-{a}", low * SLIM, a, True, False, 0.25
        yield f"slide-rock-over-{a}", high * SLIM, a, True, True, 0.25
        yield f"slide-rock-under-{a}", low * _needed(a), a, True, True, 0.2
        yield f"rock-over-{a}", high * _needed(a), a, False, True, 0.2


POINTS = list(_points())


def test_the_points_lie_in_the_regions_that_they_are_named_after():
    """By the chart's own inequalities; all four regions."""
    for name, mu, a, slides, rocks, _ in POINTS:
        rest = a < min(mu, SLIM)
        slide = a > mu and mu < SLIM
        rock = a > SLIM and mu > _needed(a)
        slide_rock = a > SLIM and SLIM < mu < _needed(a)
        assert [rest, slide, rock, slide_rock].count(True) == 1, name
        assert (slides, rocks) == (slide or slide_rock, rock or slide_rock), name
    assert len({(slides, rocks) for _, _, _, slides, rocks, _ in POINTS}) == 4


@pytest.mark.parametrize(
    ("mu", "a", "slides", "rocks", "duration"), [p[1:] for p in POINTS], ids=[p[0] for p in POINTS]
)
def test_the_chart(mu, a, slides, rocks, duration, make_structure, run_ls_dem):
    """The base's acceleration is reached within 10 ms (50 ms for rest, which must not be jerked) and held."""
    ramp = 0.01 if (slides and rocks) or duration < 0.3 else 0.05
    motion = ground_motion(
        "hold", np.array([0.0, ramp, duration]), {"x": a * G * np.array([0.0, 1.0, 1.0])}, "acceleration"
    )
    structure = make_structure([{"name": "b", "shape": "sharp", "position": [0.0, 0.0, H]}], friction=mu)
    run = run_ls_dem(structure, duration, motion=motion, time_step=2e-5)
    lean = leans(run)
    # the edge about which it leans, at -x, seen from the slab
    edge = run.position[:, 1, 0] - ROCKER.pivot * np.cos(lean) - H * np.sin(lean) - run.position[:, 0, 0]
    assert (np.abs(lean).max() > LEANS) == rocks
    assert (np.abs(edge - edge[0]).max() > SLIDES) == slides
