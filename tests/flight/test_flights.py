"""Something is hidden in simulated tosses, and the diagnosis of free flight finds it with its size."""

from dataclasses import replace

import numpy as np
import pytest
from made_flights import MASS, SIDE, campaign, drag

from blockshake_flight.arcs import find_arcs
from blockshake_flight.decide import decide_flights
from blockshake_flight.evidence import blocks_of, more_variance
from blockshake_flight.gain import flight_gain, gains_of_halves, halves_words
from blockshake_flight.impacts import find_impacts, summary
from blockshake_flight.inertia import seen_ratios
from blockshake_flight.replay import FlightModel, replay, start_arc

OPEN, SEALED = range(16), range(16, 24)


@pytest.fixture(scope="module")
def clean():
    return campaign(OPEN)


def test_clean_tosses_have_no_cause_and_their_own_restitution(clean):
    decision, evidence = decide_flights(clean)
    assert decision.decision == "none"
    assert evidence.attrs["noise"] == pytest.approx(5e-5, rel=0.2)
    impacts = summary(find_impacts(clean, find_arcs(clean)[0]))
    # Newton's law of impact of a single corner, without regard to friction: its normal velocity is e times reversed
    assert impacts["corner"]["restitution"]["median"] == pytest.approx(0.4, abs=0.03)
    # Coulomb: the impulse lies in the cone of friction
    assert impacts["corner"]["ratio"]["upper"] < 0.2 + 0.03


@pytest.mark.slow
def test_a_viscous_drag_is_found_outside_of_the_registry():
    opened, sealed = (campaign(numbers, {"external_forces": drag(0.6 * MASS)}) for numbers in (OPEN, SEALED))
    decision, _ = decide_flights(opened)
    assert decision.decision == "unknown"
    (first,) = decision.parts[0].causes
    assert first.name == "drag"
    rate = first.parameters["rate"]
    assert rate.lower < 0.6 < rate.upper
    assert rate.estimate == pytest.approx(0.6, rel=0.1)
    measured = flight_gain(opened, sealed, decision).summary
    assert measured.gain.recalibrated.lower > 0.0
    assert measured.rows.recalibrated.estimate > 0.8
    # a drag with the square of the speed is in no solver: its gain is that on the flights alone
    squared = first.model_copy(update={"name": "square-drag", "amplitudes": (0.2 * MASS,)})
    parts = (decision.parts[0].model_copy(update={"causes": (squared,)}),)
    measured = flight_gain(opened, sealed, decision.model_copy(update={"parts": parts})).summary
    assert measured.gain is None
    assert measured.rows.recalibrated.estimate > 0.0
    assert "no gain was measured on the paths" in measured.caveats[0]


@pytest.mark.parametrize("offset", [(0.006, 0.0, 0.0), (0.0, -0.004, 0.005)])
def test_an_eccentric_mass_is_named_with_its_place(offset):
    decision, _ = decide_flights(campaign(OPEN, {"body": {"mass_offset": list(offset)}}))
    assert (decision.decision, [cause.name for cause in decision.causes]) == ("named", ["eccentricity"])
    found = decision.causes[0].parameters
    assert [found[f"offset_{axis}"].estimate for axis in "xyz"] == pytest.approx(offset, abs=6e-4)


@pytest.mark.parametrize("sign", [(1.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, -1.0, 1.0)])
def test_rotations_of_the_other_hand_are_remarked(sign):
    """A mass centre off the middle circles with the body, and against rotations of a mirrored frame."""
    tracked = campaign(OPEN, {"body": {"mass_offset": [0.006, -0.004, 0.005]}})
    mirrored = [replace(test, position=test.position * sign) for test in tracked.tests]
    decision, _ = decide_flights(replace(tracked, tests=mirrored))
    told = any("other hand" in line for line in decision.cannot_see)
    assert told == (min(sign) < 0.0)


def test_lengths_read_too_long_are_named():
    decision, _ = decide_flights(campaign(OPEN, scale=0.98))
    assert (decision.decision, [cause.name for cause in decision.causes]) == ("named", ["sensor-gain"])
    assert decision.causes[0].parameters["error"].estimate == pytest.approx(-0.02, abs=2e-3)


def test_a_small_eccentricity_of_sound_blocks_is_not_named():
    decision, _ = decide_flights(campaign(OPEN, {"body": {"mass_offset": [0.001, 0.0, 0.0]}}))
    assert decision.decision == "none"


def test_causes_that_act_together_have_sizes_that_hold():
    hidden = {"external_forces": drag(0.6 * MASS), "body": {"mass_offset": [0.006, 0.0, -0.004]}}
    decision, _ = decide_flights(campaign(OPEN, hidden))
    found = {cause.name: cause.parameters for part in decision.parts for cause in part.causes[:1]}
    assert set(found) == {"drag", "eccentricity"}
    assert found["drag"]["rate"].estimate == pytest.approx(0.6, rel=0.1)
    offsets = [found["eccentricity"][f"offset_{axis}"].estimate for axis in "xyz"]
    assert offsets == pytest.approx([0.006, 0.0, -0.004], abs=4e-4)


def test_the_scatter_between_blocks_is_that_of_dersimonian_and_laird():
    # two blocks of unit variance at 0 and 2: Q = 2, tau^2 = (2 - 1) / (2 - 2 / 2) = 1, of which a mean of two has half
    assert more_variance(np.array([[0.0], [2.0]]), np.ones((2, 1))) == pytest.approx([0.5])
    assert more_variance(np.array([[0.0], [0.5]]), np.ones((2, 1))) == pytest.approx([0.0])
    # and with a second size that does not scatter: Q = 8 and 0, tau^2 = 7 and at least (7 - 1) / (1 + 1) = 3
    assert more_variance(np.array([[0.0, 0.0], [4.0, 0.0]]), np.ones((2, 2))) == pytest.approx([3.5, 1.5])
    assert [len(block) for block in blocks_of(list(map(str, range(14))))] == [5, 5, 4]
    assert blocks_of(list(map(str, range(11)))) == []


def test_intervals_count_a_frame_that_differs_by_day():
    """The tracker's origin lies elsewhere on each of four days: the mean over days is known by the days alone."""
    tracked, days = (
        campaign(range(24), {"body": {"mass_offset": [0.0, 0.004, 0.006]}}),
        [-1.5, 0.5, 2.0, -1.0],
    )
    by_day = [
        replace(test, position=test.position + 1e-3 * days[number // 6] * test.rotation[:, :, 1])
        for number, test in enumerate(tracked.tests)
    ]
    plain, _ = decide_flights(tracked)
    moved, _ = decide_flights(replace(tracked, tests=by_day))
    one, other = (decision.causes[0].parameters["offset_y"] for decision in (plain, moved))
    assert (plain.causes[0].name, moved.causes[0].name) == ("eccentricity", "eccentricity")
    assert other.lower < 0.004 < other.upper
    # standard error of the mean of four days of this scatter, of which six blocks of four tests see most
    error = 1.645e-3 * np.std(days, ddof=1) / 2.0
    assert other.upper - other.lower > error
    assert one.upper - one.lower < 0.5 * error
    assert one.lower < 0.004 < one.upper


def test_a_gain_states_the_halves_over_which_it_holds():
    errors = np.array([[2.0] * 8, [3.0] * 8])
    assert gains_of_halves(errors, 0.5 * errors) == pytest.approx(np.full(100, 0.5))
    # of two settings each is best on some tests: no half tells which one is better on the other
    tossed = np.array([[1.0, 3.0] * 4, [3.0, 1.0] * 4])
    gains = gains_of_halves(np.full((1, 8), 2.0), tossed)
    assert gains.min() < 0.0 <= gains.max()
    assert halves_words(gains).startswith(f"on {(gains > 0.0).sum()} of 100 random halves")
    assert len(gains_of_halves(errors[:, :3], errors[:, :3])) == 0


def test_a_box_that_is_no_cube_keeps_its_angular_momentum_and_not_its_spin():
    tracked = campaign(range(6), size=(0.06, 0.24, 0.16))
    arcs, _ = find_arcs(tracked)
    tests = [(test, arc) for test in tracked.tests if (arc := start_arc(test, arcs))]
    assert len(tests) >= 4
    for test, arc in tests:
        turned = replay(tracked, test, arc, FlightModel(0.2, 0.4)).turned[: len(arc.time)]
        assert np.degrees(turned.max()) < 1.0


def test_rows_without_a_pose_are_left_out_of_paths():
    tracked = campaign(range(3))
    (test, *others), rows = tracked.tests, slice(60, 64)
    position, rotation = test.position.copy(), test.rotation.copy()
    position[rows], rotation[rows] = np.nan, np.nan
    tracked = replace(tracked, tests=[replace(test, position=position, rotation=rotation), *others])
    decide_flights(tracked)
    arc = start_arc(tracked.tests[0], find_arcs(tracked)[0])
    middle = replay(tracked, tracked.tests[0], arc, FlightModel(0.2, 0.4)).middle
    assert np.flatnonzero(np.isnan(middle)).tolist() == [row - arc.first for row in range(60, 64)]
    assert np.nanmax(middle) < 0.5


def test_a_large_drag_is_not_taken_for_broken_flights():
    decision, evidence = decide_flights(campaign(OPEN, {"external_forces": drag(2.0 * MASS)}))
    assert decision.parts[0].causes[0].name == "drag"
    assert decision.parts[0].causes[0].parameters["rate"].estimate == pytest.approx(2.0, rel=0.1)
    assert evidence.attrs["left_out"] <= 2


EVEN = MASS * SIDE**2 / 6.0  # kg m2, of the cube


@pytest.mark.parametrize("moments", [(1.0, 1.0, 1.0), (1.0, 1.25, 0.9), (1.3, 1.3, 1.3)])
def test_flights_tell_the_ratios_of_the_moments_of_inertia_and_not_their_size(moments):
    """Euler's equations have the same spins where all moments are larger by a factor."""
    tracked = campaign(OPEN, {"body": {"inertia": [EVEN * one for one in moments]}})
    ratios, deviations = seen_ratios(tracked, find_arcs(tracked)[0])
    assert deviations.max() < 0.05
    away = ratios - np.log(np.array(moments[1:]) / moments[0])
    assert np.abs(away / deviations).max() < 4.0


def test_flights_in_a_plane_tell_no_moment_of_inertia(clean):
    arcs = [replace(arc, axes=np.array([0, 2])) for arc in find_arcs(clean)[0]]
    assert seen_ratios(clean, arcs) is None


def test_paths_are_nearer_with_the_inertia_that_the_body_has():
    tracked = campaign(range(8), {"body": {"inertia": [1.3 * EVEN] * 3}})
    arcs, _ = find_arcs(tracked)
    tests = [(test, arc) for test in tracked.tests if (arc := start_arc(test, arcs))]

    def error(size):
        model = FlightModel(0.2, 0.4, inertia=(np.log(size),) * 3)
        return np.mean([np.nanmean(replay(tracked, *one, model).middle) for one in tests])

    assert error(1.3) < 0.7 * min(error(1.0), error(1.6))
