"""Coulomb's limit on an incline, half a percent either side of it, for seconds and for minutes of simulated time."""

import numpy as np
import pytest
from both_solvers import solve

G = 9.81
MU = 0.5
# stretch of LS-DEM's shear springs at the limit, mu m g / (k_s A), metres
STRETCH = MU * 0.5 * 2400.0 * G / 9.0e9
WITHIN = 1e-5  # of NSCD: its tolerance of 1e-8 is relative to the weight, of which the acceleration is 0.22 %


def incline(make_structure, slope, n=1, reach=8.0, place=0.0):
    """Squat blocks on each other on an incline, their slab's length ``reach``; and the acceleration of the lowest."""
    angle = np.arctan(slope)
    bodies = [{"name": f"b{i}", "shape": "squat", "position": [place, 0.0, 0.25 + 0.5 * i]} for i in range(n)]
    structure = make_structure(
        bodies, friction=MU, gravity=[G * np.sin(angle), 0.0, -G * np.cos(angle)],
        shapes={"squat": {"box": [2.0, 1.0, 0.5]}, "slab": {"box": [reach, 1.4, 0.2]}},
    )  # fmt: skip
    return structure, G * (np.sin(angle) - MU * np.cos(angle))


@pytest.mark.parametrize(
    ("solver", "n", "duration"),
    [
        ("ls-dem", 1, 3.0), pytest.param("ls-dem", 1, 120.0, marks=pytest.mark.slow),
        pytest.param("ls-dem", 2, 60.0, marks=pytest.mark.slow), ("nscd", 1, 120.0), ("nscd", 2, 120.0),
    ],
)  # fmt: skip
def test_half_a_percent_below_the_limit_nothing_creeps(solver, n, duration, make_structure):
    """tan(angle) < mu holds for ever: 120 s are 2.4 million steps of LS-DEM, and a femtometre a step would show.

    Of two blocks each joint is as near to its limit as the other.
    """
    structure, _ = incline(make_structure, 0.995 * MU, n)
    run = solve(solver, structure, np.arange(duration + 1.0))
    assert run.status == "completed"
    gone = np.abs(run.position - run.position[0]).max()
    if solver == "nscd":
        # no spring, so no stretch; the residual of 120,000 steps at most
        assert gone < 1e-9
        assert run.energy[-1, 3] < 1e-6
        return
    # nodes still give way to one another while the last 1e-9 of imbalance dies out, in the first second
    assert gone < 1e-7 * STRETCH * (10.0 if n == 2 else 1.0)
    if duration > 10.0:
        assert np.abs(run.position[10:] - run.position[10]).max() < 1e-9 * STRETCH
    assert n == 2 or run.energy[-1, 3] < 1e-12


@pytest.mark.parametrize(
    ("solver", "duration"),
    [("ls-dem", 1.0), pytest.param("ls-dem", 100.0, marks=pytest.mark.slow), ("nscd", 60.0)],
)
def test_half_a_percent_above_it_slides_as_coulomb_says(solver, duration, make_structure):
    """Acceleration g (sin - mu cos), 0.022 m/s2: as exactly at the end as at the start.

    In the long run LS-DEM's slab has nodes at its ends and its middle alone, so that none comes under the sliding
    block: one that enters through the leading edge is pushed against the sliding for an instant, and what is tested
    here is Coulomb's law.
    """
    slope = 1.005 * MU
    _, acceleration = incline(make_structure, slope)
    reach = 0.5 * acceleration * duration**2
    structure, _ = incline(make_structure, slope, reach=2.4 * reach + 16.0, place=4.0)
    keys = {"node_spacing": reach} if solver == "ls-dem" and duration > 10.0 else {}
    run = solve(solver, structure, np.linspace(0.0, duration, 61), **keys)
    assert run.status == "completed"
    # before its springs hold back the block gains at most the speed of a mass let go on them; the block's nodes
    # carry alone, which is half of the joint's stiffness
    slack = np.sqrt(MU * G * 2.0 * STRETCH) if solver == "ls-dem" else 0.0
    gone = run.position[-1, 1, 0] - run.position[0, 1, 0]
    within = 1e-3 if solver == "ls-dem" else WITHIN
    late = run.time >= 0.2
    assert np.polyfit(run.time[late], run.velocity[late, 1, 0], 1)[0] == pytest.approx(
        acceleration, rel=within
    )
    np.testing.assert_allclose(run.velocity[:, 1, 0], acceleration * run.time, atol=slack, rtol=within)
    assert gone == pytest.approx(reach, abs=slack * duration, rel=WITHIN)
    # Coulomb's heat; the dashpots have some of the first thump, less than m slack^2 / 2
    heat = MU * structure.mass[1] * G * np.cos(np.arctan(slope)) * gone
    assert run.energy[-1, 3] == pytest.approx(heat, rel=WITHIN, abs=0.5 * structure.mass[1] * slack**2)
