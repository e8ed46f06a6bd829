"""Horizon and rate of worlds whose twins part by a known law, and of a rocking stack."""

import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.libraries.designed_test import PlannedTest
from blockshake.diagnosis.libraries.null_model import MODELS
from blockshake.diagnosis.misfit.predictability import predictability, predictability_of, twins
from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors

TIME = np.arange(2001) / 200.0
NOISE = xr.Dataset({"slip": ("joint", [1e-4]), "rotation": ("joint", [1e-4])})


def _twins(response, seed=0, n_twins=9):
    """Twins whose start is off by some micrometres, which the world carries on by ``response``."""
    off = 1e-6 * np.random.default_rng(seed).normal(0.0, 1.0, (n_twins, 1, 1))
    off[0] = 0.0
    values = np.sin(TIME)[None, :, None] + off * response(TIME)[None, :, None]
    return xr.Dataset(
        {name: (("twin", "time", "joint"), values.copy()) for name in ("slip", "rotation")},
        {"time": TIME, "joint": ["a-b"]},
    ), off.std(ddof=1)


def _nominal(scatter):
    values = np.random.default_rng(1).normal(0.0, 1.0, (20, 1, 1)) * scatter * np.ones((1, len(TIME), 1))
    return xr.Dataset(
        {name: (("draw", "time", "joint"), values) for name in ("slip", "rotation")},
        {"time": TIME, "draw": np.arange(20)},
    )


def test_a_damped_oscillator_is_predictable_to_the_end():
    moved, _ = _twins(lambda t: np.exp(-0.3 * t) * np.cos(7.0 * t))
    found = predictability(moved, NOISE, _nominal(1e-5))
    assert found["horizon"] == TIME[-1]
    assert (found["coordinate_horizon"] == TIME[-1]).all()
    assert np.isnan(found["rate"]).all()


def test_an_inverted_pendulum_parts_at_the_rate_of_theory():
    # theta'' = (g / l) theta: a start at rest grows as cosh
    rate = np.sqrt(9.81 / 4.0)
    moved, spread = _twins(lambda t: np.cosh(rate * t))
    found = predictability(moved, NOISE, _nominal(1e-5))
    assert found["horizon"].item() == pytest.approx(np.arccosh(3e-4 / spread) / rate, abs=0.01)
    np.testing.assert_allclose(found["rate"], rate, rtol=0.02)


def test_a_scattered_ensemble_makes_twins_count_for_less():
    rate = 2.0
    moved, spread = _twins(lambda t: np.exp(rate * t))
    nominal = _nominal(1e-2)
    found = predictability(moved, NOISE, nominal)
    limit = 0.3 * nominal["slip"].isel(time=0).std("draw", ddof=1).item()
    assert found["horizon"].item() == pytest.approx(np.log(limit / spread) / rate, abs=0.01)
    np.testing.assert_allclose(found["rate"], rate, rtol=1e-6)


def test_twins_of_which_one_fell_are_told_apart():
    moved, _ = _twins(np.ones_like)
    moved["rotation"][3, 1000:] = np.nan
    # a mean over the others would not see it
    found = predictability(moved, NOISE, _nominal(1e-5))
    assert found["coordinate_horizon"].sel(quantity="rotation").item() == TIME[1000]
    assert found["coordinate_horizon"].sel(quantity="slip").item() == TIME[-1]


@pytest.mark.parametrize("model", MODELS)
def test_a_stack_that_stands_still_is_predictable_and_its_twins_are_the_same_again(
    two_blocks, model, monkeypatch
):
    time = np.linspace(0.0, 0.5, 51)
    motion = ground_motion("gentle", time, {"x": 0.3 * np.sin(12.0 * time)}, "acceleration")
    structure = load_structure(two_blocks)
    markers = tuple(marker.name for marker in structure.file.markers)
    planned = PlannedTest(structure, motion, 0.5, Sensors(), markers, ())
    lines = []
    moved = twins(planned, model, 2, lines.append)
    assert len(lines) == 3
    xr.testing.assert_identical(moved, twins(planned, model, 2, lines.append))
    monkeypatch.setattr("blockshake.diagnosis.misfit.predictability.MODELS", (model,))
    found = predictability_of(planned, 2, {model: moved.rename(twin="draw")}, lines.append)
    assert found["horizon"].item() == moved["time"].values[-1]
