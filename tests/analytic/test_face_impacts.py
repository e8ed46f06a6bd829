"""A block that comes down on a face while it rocks: impacts in sequence and at once, against theory.

Lipscombe and Pellegrino (1993), J. Eng. Mech. 119(7), let a short block bounce after each impact: Newton's restitution
at the edge that is hit. The recursion is derived in docs/theory/rocking.md; Housner (1963) is its case without bounces.
"""

import numpy as np
import pytest
from face_impacts import (
    FRICTION,
    GYRATION,
    HALF,
    RATE,
    Start,
    kept_in_sequence,
    kept_together,
    posed_square,
    read,
    square,
    strike,
    strike_in_sequence,
)
from scipy.spatial.transform import Rotation

from blockshake_flight.impacts import find_impacts
from blockshake_flight.tracked_test import TrackedTest


def _rocker(half, height):
    """Velocity of a block of these half sizes that turns about its left edge, unit spin; its arms and gyration."""
    arms = np.array([[-half, -height], [half, -height]])
    return np.array([height, -half, -1.0]), arms, (half**2 + height**2) / 3.0


def _energy(velocity, gyration):
    return 0.5 * (velocity[0] ** 2 + velocity[1] ** 2 + gyration * velocity[2] ** 2)


def _housner(half, height):
    """Housner (1963): ``1 - 2 m b^2 / I`` about the far edge."""
    return 1.0 - 2.0 * half**2 / (4.0 * (half**2 + height**2) / 3.0)


def _closing(velocity, arms):
    return velocity[1] + velocity[2] * arms[:, 0]


@pytest.mark.parametrize("slenderness", [1.0, 1.5, 3.0])
def test_without_restitution_housners_spin_is_kept(slenderness):
    velocity, arms, gyration = _rocker(1.0, slenderness)
    assert strike_in_sequence(velocity, arms, np.ones(2, bool), gyration, 0.0, np.inf) == 1
    assert -velocity[2] == pytest.approx(_housner(1.0, slenderness), abs=1e-12)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("slenderness", [0.3, 0.6, 1.0, 2.0])
def test_edges_that_stick_bounce_by_the_recursion(slenderness, restitution):
    """Where Housner's r is negative, the hit edge pushes the other one down, and both are hit in turn."""
    velocity, arms, gyration = _rocker(1.0, slenderness)
    strike_in_sequence(velocity, arms, np.ones(2, bool), gyration, restitution, np.inf)
    r, opening, hit = _housner(1.0, slenderness), [0.0, -2.0], 1
    while opening[hit] < -1e-9:
        gained = -(1.0 + restitution) * opening[hit]
        opening[hit] += gained
        hit = 1 - hit
        opening[hit] += r * gained
    assert _closing(velocity, arms) == pytest.approx(opening, abs=1e-8)
    if r > 0.0:
        assert -velocity[2] == pytest.approx(r - restitution * (1.0 - r))


@pytest.mark.parametrize("friction", [0.0, 0.13, 0.4, np.inf])
def test_an_impact_follows_newton_and_coulomb_and_the_energy_is_the_work_of_its_impulse(friction):
    """The work of an impulse is the impulse times the mean velocity of its point (Kelvin)."""
    random = np.random.default_rng(42)
    for _ in range(200):
        velocity, (x, z) = random.normal(size=3), random.uniform([-1.0, -1.0], [1.0, -0.2])
        gyration, restitution = random.uniform(0.2, 1.0), random.uniform()
        if np.isinf(friction):
            velocity[0] = velocity[2] * z
        velocity[1] = -abs(velocity[1]) - velocity[2] * x
        before = velocity.copy()
        along, normal = strike(velocity, (x, z), gyration, restitution, friction)
        came, left = (np.array([one[0] - one[2] * z, one[1] + one[2] * x]) for one in (before, velocity))
        assert left[1] == pytest.approx(-restitution * came[1])
        work = np.array([along, normal]) @ (came + left) / 2.0
        assert _energy(velocity, gyration) - _energy(before, gyration) == pytest.approx(work)
        assert abs(along) <= friction * normal * (1.0 + 1e-12)
        # it sticks, or slides against its friction
        assert abs(left[0]) < 1e-9 or left[0] * along < 0.0 or friction == 0.0


def test_bounces_of_a_pivot_that_sticks_lose_the_part_of_each_impact():
    """Each impact at speed v takes ``(1 - e^2) v^2 / 2`` of the mass that the edge moves."""
    restitution = 0.6
    velocity, arms, gyration = _rocker(1.0, 1.0)
    moved = 1.0 / (1.0 + 1.0 / (gyration + 1.0))
    energy, speed = _energy(velocity, gyration), 2.0
    strike_in_sequence(velocity, arms, np.ones(2, bool), gyration, restitution, np.inf)
    lost = energy - _energy(velocity, gyration)
    assert lost == pytest.approx(0.5 * moved * (1.0 - restitution**2) * speed**2)


def test_smooth_elastic_edges_keep_the_energy_through_many_impacts():
    velocity, arms, gyration = _rocker(1.0, 0.2)
    energy = _energy(velocity, gyration)
    assert strike_in_sequence(velocity, arms, np.ones(2, bool), gyration, 1.0, 0.0) > 1
    assert _energy(velocity, gyration) == pytest.approx(energy)


@pytest.mark.parametrize("restitution", [0.2, 0.4, 0.6])
@pytest.mark.parametrize("friction", [FRICTION, 0.9])
def test_contact_dynamics_keeps_the_spin_of_both_edges_at_once(friction, restitution, run_nscd):
    """The spin jumps in one step; what gravity turns in a record and the place within a step are the tolerance."""
    rate = 10_000
    structure = square(restitution, friction, Start(0.04, 0.0, 0.0))
    run = run_nscd(structure, 0.04, rate=rate, time_step=1.0 / rate)
    spin = run.angular_velocity[:, 1, 1]
    at = int(np.argmin(np.diff(spin)))
    expected = kept_together(restitution, friction)
    assert spin[at + 1] / spin[at] == pytest.approx(expected, abs=0.02)


def test_a_square_in_sequence_differs_from_one_hit_at_once_only_where_its_pivot_is_pushed_down():
    assert kept_in_sequence(0.5, 0.9) == pytest.approx(kept_together(0.5, 0.9))
    assert kept_together(0.5, FRICTION) == -0.5
    # with friction, two factors: of a hit at the far edge, and of one at the near edge, which slides as well
    lever, other = HALF * (1.0 - FRICTION), HALF * (1.0 + FRICTION)
    far = (GYRATION - HALF * lever) / (GYRATION + HALF * lever)
    near = (GYRATION - HALF * other) / (GYRATION + HALF * other)
    opening = [0.0, -2.0]
    for hit, factor in ((1, far), (0, near)) * 40:
        gained = max(0.0, -1.5 * opening[hit])
        opening[hit] += gained
        opening[1 - hit] += factor * gained
    assert kept_in_sequence(0.5, FRICTION) == pytest.approx((opening[0] - opening[1]) / 2.0, abs=1e-8)


def test_a_path_that_is_turned_back_is_read_as_it_was_made():
    time = np.arange(31) / RATE - 0.05
    # the right edge is up by the tilt, which falls at 4 rad/s and grows again at 1 rad/s
    tilt = np.where(time < 0.0, -4.0 * time, time)
    reach = HALF * np.array([np.cos(tilt) - np.sin(tilt), np.cos(tilt) + np.sin(tilt)])
    impacts = read([np.column_stack([*reach, tilt])])
    assert [impact.kind for impact in impacts] == ["face"]
    assert impacts[0].kept == pytest.approx(-0.25, abs=0.02)


def test_a_square_that_lies_on_its_face_and_turns_does_not_come_down():
    """Noise of the tracking tilts it by a tenth of a milliradian; it turns about the vertical at 3 rad/s."""
    time = np.arange(61) / RATE
    turned = np.column_stack([1e-4 * np.random.default_rng(42).normal(size=(len(time), 2)), 3.0 * time])
    place = np.tile([0.0, 0.0, HALF], (len(time), 1))
    test = TrackedTest("turning", time, place, Rotation.from_euler("xyz", turned).as_matrix(), planar=False)
    assert list(find_impacts(posed_square([test]), [])) == []
