"""Twins of a short run."""

import numpy as np
import pandas as pd
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.comparison.twins import NUDGE, TWINS, simulate_twins
from blockshake.study.ensembles.batch import CaseRuns

CASE = {"structure": "configuration-1", "duration": 0.2}
SETTINGS = {"time_step": 1e-3, "parameters": {"nscd.impact_parts": 20}}
RATE = 200.0
FRICTION = "friction.concrete.concrete"


@pytest.fixture(scope="module")
def motion():
    time = np.linspace(0.0, 0.2, 401)
    return ground_motion("sine", time, {"x": 2.5 * np.sin(10.0 * np.pi * time)}, "acceleration")


@pytest.fixture(scope="module")
def twins(tmp_path_factory, motion):
    row, store = pd.DataFrame({FRICTION: [0.7]}), Store(tmp_path_factory.mktemp("store"), "source")
    runs = CaseRuns(CASE, "nscd-rigid", SETTINGS, {}, RATE)
    return simulate_twins(runs, lambda sample: motion, row, store)


def test_twins_are_the_sample_a_little_stronger_and_at_half_the_step(twins, motion):
    for twin, moved, step in (("nudged", motion.scaled(1.0 + NUDGE), 1e-3), ("half-step", motion, 5e-4)):
        run = simulate(
            "configuration-1", moved, "nscd-rigid", {FRICTION: 0.7, **SETTINGS["parameters"]},
            time_step=step, duration=0.2, output_rate=RATE, accelerometers=False,
        )  # fmt: skip
        # stored to a tenth of a micrometre
        np.testing.assert_allclose(
            twins["marker_displacement"].sel(twin=twin), run["marker_displacement"], atol=0.51e-7
        )
    assert tuple(twins["twin"].values) == TWINS
    assert float(np.abs(twins["marker_displacement"].diff("twin")).max()) > 1e-7
