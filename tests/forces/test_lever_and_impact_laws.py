"""Laws of a rocking joint, from histories of levers and rotations that are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.forces.laws.impact import impact_law
from blockshake.forces.laws.lever import lever_law

HALF = 0.38  # m
ERROR = 5e-3  # m, of a lever
STEP = 0.01  # s
TIME = np.arange(0.0, 20.0, STEP)
FREQUENCY = 0.7  # Hz
FACE = SimpleNamespace(half_width=HALF, lower=0, upper=1)
ABOVE = SimpleNamespace(half_width=HALF, lower=1, upper=2)


def rocking(amplitude, lever_of, ringing=0.0):
    """Two joints, the lower of which rocks to ``amplitude`` [rad] at a constant period.

    ``lever_of`` gives the size of its lever [m] by the size of its rotation; the lever of the upper one rings after
    every impact, in proportion to the angular velocity at it (``ringing`` [m s/rad]).
    """
    phase = 2.0 * np.pi * FREQUENCY * TIME
    turn, spin = amplitude * np.sin(phase), amplitude * 2.0 * np.pi * FREQUENCY * np.cos(phase)
    side = np.where(np.abs(turn) > 1e-3, np.sign(turn), 0).astype(int)
    noise = np.random.default_rng(0).normal(0.0, ERROR, len(TIME))
    since = (TIME * 2.0 * FREQUENCY) % 1.0 / (2.0 * FREQUENCY)  # s, since the last impact
    rings = ringing * np.abs(spin).max() * np.exp(-since / 0.3) * np.sin(2.0 * np.pi * 12.0 * since)
    velocity = np.zeros((len(TIME), 3, 3))
    velocity[:, 1, 1] = spin
    return SimpleNamespace(
        motion=SimpleNamespace(time=TIME, angular_velocity=velocity),
        faces=[FACE, ABOVE],
        joints=SimpleNamespace(
            side=np.column_stack([side, np.zeros_like(side)]),
            rotation=np.column_stack([turn, np.zeros_like(turn)]),
            steady=since > 0.05,
        ),
        transmitted=SimpleNamespace(
            faces=(FACE, ABOVE),
            lever=np.column_stack([side * lever_of(np.abs(turn)) + noise, rings + noise]),
            lever_error=np.full((len(TIME), 2), ERROR),
            normal=np.full((len(TIME), 2), 1e5),
        ),
    )


@pytest.mark.parametrize("amplitude", [0.008, 0.02])
def test_a_rounded_edge_is_as_short_as_its_lever_is_at_small_rotations(amplitude):
    """It rolls outwards until the edge bears: the mean lever says how far the block turned, not how worn it is."""
    told = lever_law(rocking(amplitude, lambda turn: HALF - 0.09 + np.clip(turn - 5e-3, 0.0, 5e-3) * 18.0), 0)
    assert told["lever.short"].value == pytest.approx(0.09, abs=5e-3)
    assert told["lever.short"].error < 5e-3
    assert told["lever.slope"].value > 5.0 * told["lever.slope"].error


def test_an_edge_further_in_has_one_shortfall_at_every_rotation():
    told = lever_law(rocking(0.02, lambda turn: np.full_like(turn, HALF - 0.03)), 0)
    assert told["lever.short"].value == pytest.approx(0.03, abs=3.0 * told["lever.short"].error)
    assert abs(told["lever.slope"].value) < 4.0 * told["lever.slope"].error


def test_ringing_is_one_number_however_fast_the_impacts_are():
    """Levers ring in proportion to the angular velocity that an impact stops."""
    slow, fast = (
        impact_law(rocking(amplitude, lambda turn: np.full_like(turn, HALF), ringing=0.5), 0)
        for amplitude in (0.02, 0.06)
    )
    assert fast["impact.ringing"].value == pytest.approx(slow["impact.ringing"].value, rel=0.15)
    dull = impact_law(rocking(0.06, lambda turn: np.full_like(turn, HALF), ringing=0.1), 0)
    assert fast["impact.ringing"].value > 2.0 * dull["impact.ringing"].value
