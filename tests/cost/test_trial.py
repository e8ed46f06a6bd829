"""CPU time of one run, from the whole of it or from its strongest part."""

import numpy as np
import pytest

from blockshake.cost import trial
from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure


def test_the_strongest_part_has_the_accelerations_of_the_motion_and_starts_at_rest():
    """An observer who moves steadily sees the same accelerations: blocks feel the same."""
    motion = load_motion("basso-tirreno", 2.0)
    strong = trial.from_strongest(motion)
    cut = motion.table.breaks[-1] - strong.duration
    times = np.linspace(0.0, strong.duration, 500)[1:-1]
    np.testing.assert_allclose(strong.evaluate(times, 2), motion.evaluate(times + cut, 2), atol=1e-9)
    np.testing.assert_allclose(strong.evaluate(np.zeros(1))[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(strong.evaluate(np.array([1e-9]), 1)[0], 0.0, atol=1e-6)
    largest = np.abs(motion.evaluate(motion.table.breaks, 2)[:, :3]).max()
    assert np.abs(strong.evaluate(np.zeros(1), 2)).max() == pytest.approx(largest)


@pytest.mark.parametrize(("rate", "runs", "expected"), [(0.5, 1, 7.0), (20.0, 49, 200.0), (20.0, 50, 202.0)])
def test_a_slow_run_of_few_is_tried_in_part(monkeypatch, rate, runs, expected):
    """A run of 10 s costs 2 CPU s to set up and 0.5 a second: tried whole. At 20 a second: by its strongest part, but
    for many."""

    def seconds(call):
        asked.clear()
        call()
        return 2.0 + rate * asked["duration"]

    asked = {}
    monkeypatch.setattr(trial, "cpu_seconds", seconds)
    monkeypatch.setattr(trial, "simulate", lambda *given, duration, **others: asked.update(duration=duration))
    structure, motion = load_structure("configuration-1"), load_motion("alkion")
    assert trial.run_seconds(structure, motion, {"model": "ls-dem"}, 10.0, runs) == pytest.approx(expected)
