"""Something is hidden in simulated tosses, and the diagnosis of free flight finds it with its size."""

import pytest
from made_flights import MASS, campaign, drag

from blockshake.diagnosis.flight.decide import decide_flights
from blockshake.diagnosis.flight.gain import flight_gain
from blockshake.forces.flight.arcs import find_arcs
from blockshake.forces.flight.impacts import find_impacts, summary

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


@pytest.mark.parametrize("offset", [(0.006, 0.0, 0.0), (0.0, -0.004, 0.005)])
def test_an_eccentric_mass_is_named_with_its_place(offset):
    decision, _ = decide_flights(campaign(OPEN, {"body": {"mass_offset": list(offset)}}))
    assert (decision.decision, [cause.name for cause in decision.causes]) == ("named", ["eccentricity"])
    found = decision.causes[0].parameters
    assert [found[f"offset_{axis}"].estimate for axis in "xyz"] == pytest.approx(offset, abs=6e-4)


def test_lengths_read_too_long_are_named():
    decision, _ = decide_flights(campaign(OPEN, scale=0.98))
    assert (decision.decision, [cause.name for cause in decision.causes]) == ("named", ["sensor-gain"])
    assert decision.causes[0].parameters["error"].estimate == pytest.approx(-0.02, abs=2e-3)


def test_a_small_eccentricity_of_sound_blocks_is_not_named():
    decision, _ = decide_flights(campaign(OPEN, {"body": {"mass_offset": [0.001, 0.0, 0.0]}}))
    assert decision.decision == "none"
