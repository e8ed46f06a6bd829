"""Designs that grow: earlier samples stay to the bit, strata are nested, and a study states why it stops."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import load_json, write_dataset
from blockshake.statistics.intervals import share_interval
from blockshake.study.config import StudyConfig
from blockshake.study.growth import accuracy, grow, reached
from blockshake.study.sampling.latin_hypercube import draw_samples

EVEN = {name: {"distribution": "uniform"} for name in ("restitution", "nscd_restitution", "motion.heading")}


def test_a_larger_design_keeps_the_smaller_ones_to_the_bit():
    alone = draw_samples(50, 1, EVEN, effort=1).values
    parts = [draw_samples(size, 1, EVEN, effort=1, batch=50).values for size in (50, 100, 150)]
    pd.testing.assert_frame_equal(alone, parts[0], check_exact=True)
    pd.testing.assert_frame_equal(parts[2][:100], parts[1], check_exact=True)
    pd.testing.assert_frame_equal(parts[1][:50], alone, check_exact=True)


def test_every_addition_is_a_latin_hypercube_and_strata_are_nested():
    size, count = 20, 7
    values = draw_samples(size * count, 3, EVEN, effort=1, batch=size).values.to_numpy()
    for part in np.split(values, count):
        np.testing.assert_array_equal(np.sort((part * size).astype(int), axis=0).T, [np.arange(size)] * 3)
    places = np.sort(values * size % 1.0, axis=0)
    # every stratum has its median and, of each pair of additions, one on either side: an eighth each
    for column in values.T:
        inside = np.round((column * size % 1.0) * 8.0, 9).reshape(count, size)
        strata = (column * size).astype(int).reshape(count, size)
        for stratum in range(size):
            assert sorted(inside[strata == stratum]) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    assert places.min() > 0.0


def test_the_correlation_is_controlled_in_each_addition():
    names = list(EVEN)
    target = pd.DataFrame(np.eye(3), names, names)
    target.iloc[0, 1] = target.iloc[1, 0] = 0.6
    values = draw_samples(120, 1, EVEN, correlation=target, batch=40).values
    for part in np.split(values.to_numpy(), 3):
        np.testing.assert_allclose(np.corrcoef(part, rowvar=False), target, atol=5e-3)


def test_a_size_that_no_addition_reaches_is_refused():
    with pytest.raises(InputError, match="multiple of 20"):
        draw_samples(50, 1, EVEN, batch=20)


@pytest.fixture
def config():
    case = {
        "name": "wall",
        "structure": "wall.yaml",
        "motion": "push.csv",
        "duration": 1.0,
        "input": "commanded",
    }
    return StudyConfig.model_validate({
        "name": "grows", "description": "d", "models": {"nscd-rigid": {"time_step": 1e-3}}, "cases": [case],
        "ensemble": {"size": 60, "batch": 20, "seed": 1, "until": {"collapse probability": "12 %"}},
    })  # fmt: skip


def write_samples(results, fallen, size):
    status = ["collapsed"] * fallen + ["completed"] * (size - fallen)
    peak = np.linspace(1.0, 2.0, size).reshape(size, 1, 1)
    samples = xr.Dataset(
        {"status": ("sample", status), "peak": (("sample", "frame", "marker"), peak)},
        {"sample": np.arange(size), "frame": ["slab"], "marker": ["top"]},
    )
    write_dataset(results / "grows" / "samples" / "nscd-rigid" / "wall.nc", samples)


def test_a_study_grows_until_its_limits_are_narrow(tmp_path, config):
    assert reached(config, tmp_path).ensemble.size == 20
    write_samples(tmp_path, 8, 20)
    words, stopped = grow(config, tmp_path)
    low, high = share_interval(8, 20)
    assert not stopped
    assert (
        words
        == f"20 samples are not enough: collapse probability within {(high - low) / 2:.3g}, requested 0.12"
    )
    assert reached(config, tmp_path).ensemble.size == 40
    write_samples(tmp_path, 2, 40)
    words, stopped = grow(config, tmp_path)
    assert stopped
    assert words.startswith("stopped at 40 samples, as accurate as set: collapse probability within 0.0")
    # the same command again decides the same
    assert grow(config, tmp_path) == (words, True)
    assert [one["size"] for one in load_json(tmp_path / "grows" / "growth.json")["history"]] == [20, 40]


def test_a_study_stops_at_its_largest_size(tmp_path, config):
    for size in (20, 40, 60):
        write_samples(tmp_path, size // 2, size)
        words, stopped = grow(config, tmp_path)
    assert stopped
    assert words.startswith("stopped at 60 samples, the largest size: ")
    other = config.model_copy(update={"ensemble": config.ensemble.model_copy(update={"seed": 2})})
    assert reached(other, tmp_path).ensemble.size == 20


def test_the_accuracy_of_a_median_is_that_of_its_order_statistics(tmp_path, config):
    write_samples(tmp_path, 0, 20)
    found = accuracy(config, tmp_path)
    # of 20 values the 6th and the 15th hold the median with 95 %
    assert found["median_drift"] == pytest.approx(0.5 * 9.0 / 19.0 / 1.5, rel=1e-9)
    assert found["limit_states"] == 0.0
