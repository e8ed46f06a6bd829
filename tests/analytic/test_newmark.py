"""Newmark's (1965) sliding block: a pulse, a ramp, and two horizontal components that are not proportional."""

import numpy as np
import pytest
from both_solvers import both, solve
from sliding_theory import MU, TWO_COMPONENTS, G, shaken, slide, slips

from blockshake.dynamics.motion import ground_motion

# mu h/b of 0.125 along x and 0.25 along y: no part of the face lifts
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}, "slab": {"box": [8.0, 6.0, 0.2]}}
BODY = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
# Newmark's block is rigid: a hundredfold shear stiffness brings LS-DEM's springs ten times nearer to it in speed
STIFF = {"ls-dem": {"shear_stiffness": 9.0e11}, "nscd": {}}
STEPS = {"ls-dem": (1e-5,), "nscd": (1e-3, 5e-4, 2.5e-4)}
# what the shear springs give before Coulomb's limit, mu m g / (k_s A), metres
STRETCH = MU * 0.5 * 2400.0 * G / STIFF["ls-dem"]["shear_stiffness"]


def onset(acceleration):
    """Speed with which sliding sets in, that the springs let the block gain at the most: sqrt(2 a x) [m/s]."""
    return np.sqrt(2.0 * acceleration * STRETCH)


@pytest.fixture
def runs(make_structure):
    """Run of the block under a motion by each step of a solver, with its step."""

    def make(solver, motion, duration):
        structure = make_structure([BODY], friction=MU, shapes=SHAPES)
        for step in STEPS[solver]:
            yield solve(solver, structure, duration, motion, step, **STIFF[solver]), step

    return make


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


@both
def test_a_pulse(solver, runs):
    """A base at 0.8 g for 0.1 s and then at steady speed: the lag, and the way back at mu g."""
    a, duration = 0.8 * G, 0.1
    time = np.array([0.0, 1e-9, duration, duration + 1e-9, 0.5])
    motion = ground_motion("pulse", time, {"x": np.array([0.0, a, a, 0.0, 0.0])}, "acceleration")
    # the base gains a t, the block mu g t; the block catches up with mu g
    lag = a - MU * G
    expected = -(0.5 * lag * duration**2 + (lag * duration) ** 2 / (2.0 * MU * G))
    for run, step in runs(solver, motion, 0.4):
        # NSCD: onset and stop fall somewhere within a step, at the speed of the lag
        within = onset(a) * duration * a / (MU * G) if solver == "ls-dem" else lag * duration * step
        assert slips(run)[-1, 0] == pytest.approx(expected, abs=within)


@both
def test_a_ramp_of_acceleration(solver, runs):
    """The base's acceleration grows as j t: rest until mu g / j, then the slip is -j (t - t1)^3 / 6."""
    jerk, duration = 4.0 * G, 0.3
    time = np.linspace(0.0, duration, 31)
    motion = ground_motion("ramp", time, {"x": jerk * time}, "acceleration")
    begun = MU * G / jerk
    # Before it slides LS-DEM's block gives way by STRETCH and by its nod, mu m g h^2 / k_theta at the mass centre,
    # and so starts with the rate of that; the nodes slip one after the other from the lightly pressed end on,
    # which softens the joint: a small factor, 6, on the rate. 5e-7 m of 0.03 m in all.
    nod = MU * 2400.0 * G * 0.25**2 / (2.16e10 * 2.0**3 / 12.0)
    for run, step in runs(solver, motion, duration):
        since = np.maximum(run.time - begun, 0.0)
        within = (STRETCH + nod) * (1.0 + 6.0 * (duration - begun) / begun)
        if solver == "nscd":  # the relative speed is off by what a step of the excess acceleration gives
            within = (jerk * duration - MU * G) * step * since[-1]
        np.testing.assert_allclose(slips(run)[:, 0], -jerk * since**3 / 6.0, atol=within)
        assert np.abs(slips(run)[:, 1]).max() < 1e-9


@both
@pytest.mark.parametrize(("x", "y", "sticks"), TWO_COMPONENTS)
def test_two_components_slide_along_the_relative_velocity(x, y, sticks, solver, runs):
    """Friction opposes the slip velocity, not each component: a square limit or a lagging direction shows.

    ``x`` and ``y``: amplitude [g], frequency [Hz], phase of the base's acceleration.
    """
    motion, reference = shaken(x, y, 1.0)
    assert np.ptp(reference, axis=0).min() > 0.005
    rests = (np.linalg.norm(np.diff(reference, axis=0), axis=1) == 0.0).mean()
    assert sticks is None or (rests > 0.02) == sticks
    errors = []
    for run, _ in runs(solver, motion, 1.0):
        expected = reference[:: (len(reference) - 1) // (len(run.time) - 1)]
        errors.append(np.abs(slips(run) - expected).max())
    if solver == "ls-dem":
        # every onset of sliding may miss its speed under 1 g until the slip velocity has forgotten it, about
        # speed / (mu g); the first starts with a jerk where the base does, and is felt longest, 0.1 s
        assert errors[0] < onset(G) * 0.1
    else:
        # g dt of relative speed, the friction's or the base's in a step, forgotten within a tenth of a second
        assert errors[0] < G * STEPS[solver][0] * 0.1
        # of first order where it stops and goes, better where it slides all the time
        assert errors[2] < 0.35 * errors[0]
