"""A table that errs: its gain by frequency, the phase between, its pitch; and one that does not."""

import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.effects.effect import Experiment
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.virtual.settings import TableErrors
from blockshake.virtual.shake_table import followed

STRUCTURE = load_structure("configuration-1")


def on_table(motion, **table):
    return followed(Experiment(STRUCTURE, motion, Instruments()), TableErrors(**table)).motion


@pytest.mark.parametrize("frequency", [0.2, 2.0, 15.0])
def test_a_sine_has_the_gain_and_the_phase_of_its_frequency(frequency):
    time = np.arange(0.0, 10.0, 0.002)
    command = ground_motion("sine", time, {"x": np.sin(2 * np.pi * frequency * time)}, "displacement")
    found = on_table(command, gain=1.03, high=-0.06, corner=2.0).evaluate(time)[:, 0]
    late = time >= 5.0  # five time constants of the filter and whole periods
    phasor = 2.0 * np.mean(found[late] * 1j * np.exp(-2j * np.pi * frequency * time[late]))
    expected = 1.03 - 0.06 * 1j * frequency / (2.0 + 1j * frequency)
    assert phasor == pytest.approx(expected, abs=2e-3)


def test_pitch_follows_the_acceleration_and_an_exact_table_changes_nothing():
    motion = load_motion("alkion")
    assert np.array_equal(on_table(motion).table.coefficients, motion.table.coefficients)
    time = np.arange(0.0, 10.0, 0.01)
    pitch = on_table(motion, pitch=1e-4).evaluate(time)[:, 3]
    acceleration = motion.evaluate(time, 2)[:, 0]
    assert np.corrcoef(pitch, acceleration)[0, 1] > 0.8
    assert pitch @ acceleration / (acceleration @ acceleration) == pytest.approx(1e-4, rel=0.2)
