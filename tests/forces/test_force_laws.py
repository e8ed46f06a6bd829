"""Histories that follow one law are told from all others."""

from dataclasses import replace

import numpy as np
import pytest

from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import PushHistory

TIME = np.arange(0.0, 10.0, 0.01)
ERROR = 200.0  # N
MOVED = 0.04 * np.sin(2.0 * np.pi * 0.7 * TIME) * np.exp(-0.1 * TIME)
RATE = np.gradient(MOVED, TIME)
FORCES = {
    "steady": np.full(len(TIME), -2000.0),
    "constant": np.where(TIME > 4.0, -2200.0, 0.0),
    "pulse": np.where((TIME > 3.5) & (TIME < 3.58), 20e3, 0.0),
    "spring": -5e6 * np.maximum(MOVED - 0.015, 0.0),
    "damper": -2e4 * RATE,
    "proportional": -1e5 * MOVED,
}


def history(force, seed=0):
    noise = np.random.default_rng(seed).normal(0.0, ERROR, len(TIME))
    return PushHistory(
        body=1,
        height=0.0,
        force=force + noise,
        error=np.full(len(TIME), ERROR),
        told=np.ones(len(TIME), dtype=bool),
        distance=np.zeros(len(TIME)),
        edge=np.zeros(len(TIME)),
        friction=np.zeros(len(TIME)),
        lower=np.full(len(TIME), -np.inf),
        upper=np.full(len(TIME), np.inf),
        by_lever=np.zeros(len(TIME)),
        displacement=MOVED,
        velocity=RATE,
    )


@pytest.mark.parametrize("law", FORCES)
def test_the_law_of_a_history_is_told_from_all_others(law):
    best, second, *_ = fit_laws(TIME, history(FORCES[law]))
    assert best.name == law
    assert second.information - best.information > 5.0


def test_no_force_is_told_from_any():
    """A hundred histories of noise alone: the criterion of Schwarz (1978) seldom prefers a law."""
    preferred = [fit_laws(TIME, history(np.zeros(len(TIME)), seed))[0].name for seed in range(100)]
    assert preferred.count("none") >= 90


@pytest.mark.parametrize(("law", "amplitude"), [("constant", -2200.0), ("spring", 5e6), ("damper", -2e4)])
def test_amplitudes_are_within_their_errors(law, amplitude):
    best = fit_laws(TIME, history(FORCES[law]))[0]
    assert best.amplitude == pytest.approx(amplitude, abs=max(4.0 * best.error, 0.05 * abs(amplitude)))


def test_starts_and_gaps_are_those_of_the_history():
    assert fit_laws(TIME, history(FORCES["constant"]))[0].parameters["start"] == pytest.approx(4.0, abs=0.06)
    assert fit_laws(TIME, history(FORCES["spring"]))[0].parameters["gap"] == pytest.approx(0.015, abs=2e-3)
    pulse = fit_laws(TIME, history(FORCES["pulse"]))[0].parameters
    assert pulse["start"] == pytest.approx(3.5, abs=0.03)


def test_a_history_that_tells_nothing_has_no_law():
    nothing = history(FORCES["constant"])
    nothing.told[:] = False
    assert fit_laws(TIME, nothing) == []


def test_times_at_which_the_force_is_bounded_alone_tell_its_start():
    """Nothing is turned before 6 s; a joint that stays closed until 4 s would have turned under the later force."""
    whole = history(FORCES["constant"])
    told = TIME > 6.0
    unbounded = replace(whole, told=told)
    assert fit_laws(TIME, unbounded)[0].name == "steady"
    lower = np.where(TIME < 4.0, -500.0, -4000.0)
    best = fit_laws(TIME, replace(unbounded, lower=lower, upper=np.full(len(TIME), 4000.0)))[0]
    assert best.name == "constant"
    # any start between the last instant that the force would have opened and the first that tells it
    assert best.parameters["earliest"] == pytest.approx(4.0, abs=0.06)
    assert best.parameters["latest"] == pytest.approx(6.0, abs=0.06)
    assert best.parameters["start"] == pytest.approx(5.0, abs=0.06)
    assert best.amplitude == pytest.approx(-2200.0, rel=0.02)


def rocking(further_out, force=0.0):
    """A block that rocks on edges which lie elsewhere than the structure has them, under a force."""
    turn = np.sin(np.pi * TIME) * (1.0 + 0.5 * np.cos(0.3 * np.pi * TIME))
    side, by_lever, half_width, lever_error = np.sign(turn), 30e3, 0.4, 2e-3
    lever = side * (half_width + further_out) + np.random.default_rng(0).normal(0.0, lever_error, len(TIME))
    return replace(
        history(np.zeros(len(TIME))),
        force=by_lever * (side * half_width - lever) + force,
        error=np.full(len(TIME), by_lever * lever_error),
        told=np.abs(turn) > 0.3,
        edge=side * by_lever,
        lower=by_lever * (-half_width - lever) + force,
        upper=by_lever * (half_width - lever) + force,
        by_lever=np.full(len(TIME), by_lever),
        displacement=0.06 * turn,
    )


@pytest.mark.parametrize("further_out", [-12e-3, 0.0, 12e-3])
def test_edges_that_lie_elsewhere_are_no_force(further_out):
    """The force and its ends go along with the edges."""
    push = rocking(further_out)
    none = next(one for one in fit_laws(TIME, push) if one.name == "none")
    assert fit_laws(TIME, push)[0].name == "none"
    assert none.chi_square < 1.2 * push.told.sum()
    best = fit_laws(TIME, rocking(further_out, -2000.0))[0]
    assert best.name == "steady"
    assert best.amplitude == pytest.approx(-2000.0, abs=20.0)


@pytest.mark.parametrize("further_out", [-12e-3, 0.0, 12e-3])
def test_a_rope_is_told_from_edges_that_lie_elsewhere(further_out):
    """Both push back on both sides; the rope by the displacement, the edges by the same force throughout."""
    moved = rocking(0.0).displacement
    best = fit_laws(TIME, rocking(further_out, -1e5 * moved))[0]
    assert best.name == "proportional"
    assert best.amplitude == pytest.approx(-1e5, abs=4.0 * best.error)


@pytest.mark.parametrize("more", [0.0, 0.1, 0.15])
def test_a_drag_is_told_from_more_friction(more):
    """Both act against the slip: the drag by its rate, friction by the same force at every rate."""
    friction = -30e3 * np.sign(RATE) * (np.abs(RATE) > 0.01)
    push = replace(history(more * friction), friction=friction)
    assert fit_laws(TIME, push)[0].name == "none"
    best = fit_laws(TIME, replace(push, force=push.force + FORCES["damper"]))[0]
    assert best.name == "damper"
    assert best.amplitude == pytest.approx(-2e4, abs=4.0 * best.error)


def test_a_stop_on_either_side_is_one_spring_with_a_second_gap():
    both = FORCES["spring"] + 8e6 * np.maximum(-MOVED - 0.02, 0.0)
    best = fit_laws(TIME, history(both))[0]
    assert best.name == "spring"
    gaps = {best.parameters["gap"], best.parameters["other_gap"]}
    assert sorted(gaps) == pytest.approx([0.015, 0.02], abs=2e-3)
    assert sorted([best.amplitude, best.parameters["other_amplitude"]]) == pytest.approx([5e6, 8e6], rel=0.1)
    assert "other_gap" not in fit_laws(TIME, history(FORCES["spring"]))[0].parameters
