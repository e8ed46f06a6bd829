"""Twins of a short run, and the impact of one block against Housner's."""

import numpy as np
import pandas as pd
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.comparison.kicked_block import housner_ratio
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


def test_housners_ratio_is_that_of_the_flat_of_a_block():
    """Housner (1963) for a base of 0.76 m between chamfers; the chamfer takes 0.1 % of mass and inertia."""
    pivot, half = 0.38, 0.8
    about_edge = (0.8**2 + 1.6**2) / 12.0 + pivot**2 + half**2
    expected = 1.0 - 2.0 * pivot**2 / about_edge
    assert housner_ratio(load_structure("configuration-1")) == pytest.approx(expected, rel=1e-3)


def test_a_rigid_block_on_corners_keeps_what_housner_says(twins):
    """Impacts are placed to a part of the step: half a per cent of the ratio, less at half the step."""
    error = np.abs(twins["impact_ratio"] / twins["housner_ratio"] - 1.0)
    assert float(error.sel(step="usual")) < 5e-3
    assert float(error.sel(step="half")) < float(error.sel(step="usual"))
