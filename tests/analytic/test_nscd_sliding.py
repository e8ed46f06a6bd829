"""Newmark's (1965) rigid block, which NSCD is: one component in closed form, two against `sliding_theory`."""

import numpy as np
import pytest
from rocking_theory import G, H, Rocker, leans
from shenton_theory import edge_of, hold, points
from sliding_theory import MU, TWO_COMPONENTS, shaken, slips

from blockshake.dynamics.motion import ground_motion

# mu h/b of 0.125 along x and 0.25 along y: no part of the face lifts
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}, "slab": {"box": [8.0, 6.0, 0.2]}}
BODY = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
STEPS = (1e-3, 5e-4, 2.5e-4)


def _run(make_structure, run_nscd, motion, duration, step):
    structure = make_structure([BODY], friction=MU, shapes=SHAPES)
    return run_nscd(structure, duration, motion=motion, time_step=step)


def test_a_pulse_in_closed_form(make_structure, run_nscd):
    """A base at 0.8 g for 0.1 s and then at steady speed: the lag, and the way back at mu g."""
    a, duration = 0.8 * G, 0.1
    time = np.array([0.0, 1e-9, duration, duration + 1e-9, 0.5])
    motion = ground_motion("pulse", time, {"x": np.array([0.0, a, a, 0.0, 0.0])}, "acceleration")
    lag = a - MU * G
    expected = -(0.5 * lag * duration**2 + (lag * duration) ** 2 / (2.0 * MU * G))
    for step in STEPS:
        run = _run(make_structure, run_nscd, motion, 0.4, step)
        # onset and stop fall somewhere within a step, at the speed of the lag
        assert slips(run)[-1, 0] == pytest.approx(expected, abs=lag * duration * step)


def test_a_ramp_in_closed_form(make_structure, run_nscd):
    """The base's acceleration grows as j t: rest until mu g / j, then the slip is -j (t - t1)^3 / 6."""
    jerk, duration = 4.0 * G, 0.3
    time = np.linspace(0.0, duration, 31)
    motion = ground_motion("ramp", time, {"x": jerk * time}, "acceleration")
    for step in STEPS:
        run = _run(make_structure, run_nscd, motion, duration, step)
        since = np.maximum(run.time - MU * G / jerk, 0.0)
        # the relative speed is off by what a step of the excess acceleration gives
        excess = jerk * duration - MU * G
        np.testing.assert_allclose(slips(run)[:, 0], -jerk * since**3 / 6.0, atol=excess * step * since[-1])
        assert np.abs(slips(run)[:, 1]).max() < 1e-9


@pytest.mark.parametrize(("x", "y", "sticks"), TWO_COMPONENTS)
def test_two_components_slide_along_the_relative_velocity(x, y, sticks, make_structure, run_nscd):
    """Friction opposes the slip velocity, not each component: a square limit or a lagging direction shows."""
    motion, reference = shaken(x, y, 1.0)
    assert np.ptp(reference, axis=0).min() > 0.005
    errors = []
    for step in STEPS:
        run = _run(make_structure, run_nscd, motion, 1.0, step)
        expected = reference[:: (len(reference) - 1) // (len(run.time) - 1)]
        errors.append(np.abs(slips(run) - expected).max())
    # g dt of relative speed, the friction's or the base's in a step, forgotten within a tenth of a second
    assert errors[0] < G * STEPS[0] * 0.1
    # of first order where it stops and goes, better where it slides all the time
    assert errors[2] < 0.35 * errors[0]


ROCKER = Rocker(0.0)
POINTS = list(points(ROCKER, 0.03))


@pytest.mark.parametrize(
    ("mu", "a", "slides", "rocks", "duration"), [p[1:] for p in POINTS], ids=[p[0] for p in POINTS]
)
def test_shentons_chart(mu, a, slides, rocks, duration, make_structure, run_nscd):
    """3 % off each boundary, as for LS-DEM; a rigid block that does not rock does not lean at all."""
    structure = make_structure([{"name": "b", "shape": "sharp", "position": [0.0, 0.0, H]}], friction=mu)
    # the base stops dead after its last row
    motion = hold(a, slides, rocks, duration + 0.01)
    run = run_nscd(structure, duration, motion=motion, time_step=5e-4)
    lean = leans(run)
    edge = edge_of(run, ROCKER, lean)
    # 3 % over a boundary moves millimetres and hundredths within the run; under it there is only rounding,
    # and of an edge that turns without slip, w^2 r dt^2 / 2 a step
    assert (np.abs(lean).max() > 8e-3) == rocks
    assert (np.abs(edge - edge[0]).max() > 1e-3) == slides
    if not rocks:
        assert np.abs(lean).max() < 1e-7
    if not slides:
        assert np.abs(edge - edge[0]).max() < 1e-5
