"""Newmark's (1965) sliding block under a ramp and under two horizontal components that are not proportional."""

import numpy as np
import pytest
from sliding_theory import MU, TWO_COMPONENTS, shaken, slide, slips

from blockshake.dynamics.motion import ground_motion

G = 9.81
# mu h/b of 0.125 along x and 0.25 along y: no part of the face lifts
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}, "slab": {"box": [8.0, 6.0, 0.2]}}
BODY = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
# Newmark's block is rigid: a hundredfold shear stiffness brings the springs ten times nearer to it in speed
STIFF = {"shear_stiffness": 9.0e11, "time_step": 1e-5}
# what the shear springs give before Coulomb's limit, mu m g / (k_s A), metres
STRETCH = MU * 0.5 * 2400.0 * G / STIFF["shear_stiffness"]
# sliding sets in with at most the speed that the springs let the block gain: sqrt(2 a x) under 1 g
ONSET = np.sqrt(2.0 * G * STRETCH)


def test_the_reference_is_newmarks_in_one_component():
    """Closed form: a base that gains 0.8 g for 0.1 s; the block lags, then catches up at mu g."""
    n = 40_000
    time = (np.arange(n) + 0.5) * 0.4 / n
    a = np.zeros((n, 2))
    a[time < 0.1, 1] = 0.8 * G
    lag = 0.3 * G
    expected = -(0.5 * lag * 0.1**2 + (lag * 0.1) ** 2 / (2.0 * MU * G))
    # implicit Euler: of first order in the step, speed dt at the most
    assert slide(a, 0.4)[-1, 1] == pytest.approx(expected, abs=lag * 0.1 * 0.4 / n)


def test_a_ramp_of_acceleration(make_structure, run_ls_dem):
    """The base's acceleration grows as j t: rest until mu g / j, then the slip is -j (t - t1)^3 / 6."""
    jerk = 4.0 * G
    time = np.linspace(0.0, 0.3, 31)
    motion = ground_motion("ramp", time, {"x": jerk * time}, "acceleration")
    run = run_ls_dem(make_structure([BODY], friction=MU, shapes=SHAPES), 0.3, motion=motion, **STIFF)
    since = np.maximum(run.time - MU * G / jerk, 0.0)
    expected = -jerk * since**3 / 6.0
    assert expected[-1] < -0.02
    slip = slips(run)
    # Before it slides the block gives way by STRETCH and by its nod, mu m g h^2 / k_theta at the mass centre,
    # and so starts with the rate of that; the nodes slip one after the other from the lightly pressed end on,
    # which softens the joint: a small factor, 6, on the rate. 5e-7 m of 0.03 m in all.
    nod = MU * 2400.0 * G * 0.25**2 / (2.16e10 * 2.0**3 / 12.0)
    begun = MU * G / jerk
    np.testing.assert_allclose(
        slip[:, 0], expected, atol=(STRETCH + nod) * (1.0 + 6.0 * (0.3 - begun) / begun)
    )
    assert np.abs(slip[:, 1]).max() < 1e-9


@pytest.mark.parametrize(("x", "y", "sticks"), TWO_COMPONENTS)
def test_two_components_slide_along_the_relative_velocity(x, y, sticks, make_structure, run_ls_dem):
    """Friction opposes the slip velocity, not each component: a square limit or a lagging direction shows.

    ``x`` and ``y``: amplitude [g], frequency [Hz], phase of the base's acceleration.
    """
    duration = 1.0
    motion, reference = shaken(x, y, duration)
    run = run_ls_dem(make_structure([BODY], friction=MU, shapes=SHAPES), duration, motion=motion, **STIFF)
    expected = reference[:: (len(reference) - 1) // (len(run.time) - 1)]
    assert np.ptp(expected, axis=0).min() > 0.005
    rests = (np.linalg.norm(np.diff(reference, axis=0), axis=1) == 0.0).mean()
    if sticks is not None:
        assert (rests > 0.02) == sticks
    # every onset of sliding may miss ONSET of speed until the slip velocity has forgotten it, about
    # ONSET / (mu g); the first starts with a jerk where the base does, and is felt longest
    felt = 0.1
    np.testing.assert_allclose(slips(run), expected, atol=ONSET * felt)
