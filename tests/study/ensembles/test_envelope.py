import numpy as np
import pytest
import xarray as xr

from blockshake.files import write_dataset
from blockshake.study.ensembles import envelope as module
from blockshake.study.ensembles.ensemble import DECIMALS, join_batches
from blockshake.study.ensembles.envelope import (
    QUANTILES,
    envelope,
    envelope_of_case,
    is_moving,
    over_samples,
    still_moves,
)

ROUNDING = 1e-12  # m
LIMIT = 0.4  # m


def test_bounds_and_quantiles_of_eleven_constant_curves(make_run, gather):
    # 0, 1, ... 10 mm in mixed order: the quantile q is 10 q mm
    levels = 1e-3 * np.array([3, 0, 7, 10, 1, 9, 4, 2, 8, 5, 6])
    result = envelope(gather([make_run(level, slab=0.1) for level in levels]), LIMIT)
    along = result.sel(marker="block-1-face", axis="x").isel(time=slice(1, None))
    slab, inertial = along.sel(frame="slab"), along.sel(frame="inertial")
    np.testing.assert_allclose(slab["marker_envelope"].sel(bound="lower"), 0.0, atol=ROUNDING)
    np.testing.assert_allclose(slab["marker_envelope"].sel(bound="upper"), 0.01, atol=ROUNDING)
    np.testing.assert_allclose(inertial["marker_envelope"].sel(bound="upper"), 0.11, atol=ROUNDING)
    for quantile in QUANTILES:
        expected = 0.01 * quantile
        curve = slab["marker_displacement"].sel(quantile=quantile)
        np.testing.assert_allclose(curve, expected, atol=ROUNDING)
        assert slab["peak"].sel(quantile=quantile) == pytest.approx(expected, abs=ROUNDING)
        assert slab["residual"].sel(quantile=quantile) == pytest.approx(expected, abs=ROUNDING)
    np.testing.assert_array_equal(result["contributing"], 11)
    assert result["marker_envelope"].dims == ("frame", "bound", "time", "marker", "axis")
    assert list(result["bound"].values) == ["lower", "upper"]


def test_only_runs_that_ended_well_or_collapsed_count(make_run, gather):
    result = envelope(
        gather(
            [
                make_run(0.01),
                make_run(0.02),
                make_run(0.5, status="collapsed", end=1.0),
                make_run(9.0, status="diverged"),
                make_run(9.0, status="not-converged"),
            ]
        ),
        LIMIT,
    )
    upper = result["marker_envelope"].sel(frame="slab", bound="upper", marker="block-1-face", axis="x")
    time = result["time"].to_numpy()
    before, after = (time > 0.0) & (time <= 1.0), time > 1.0
    np.testing.assert_allclose(upper[before], 0.5, atol=ROUNDING)
    np.testing.assert_allclose(upper[after], 0.02, atol=ROUNDING)
    np.testing.assert_array_equal(result["contributing"], np.where(after, 2, 3))
    assert (result.attrs["samples"], result.attrs["counted"]) == (5, 3)
    # the collapsed run's peak counts, its residual does not exist
    block = result.sel(frame="slab", marker="block-1-face")
    assert block["peak"].sel(quantile=0.5) == pytest.approx(0.02, abs=ROUNDING)
    assert block["residual"].sel(quantile=0.5) == pytest.approx(0.015, abs=ROUNDING)


@pytest.mark.parametrize(("size", "share"), [(2e-3, 0.75), (0.4e-3, 0.0)])
def test_samples_that_swing_against_each_other_still_move(make_run, gather, size, share):
    """Their median rests; one that fell has no residual and does not count, one at rest does."""
    time = make_run(0.0)["time"].to_numpy()
    swing = size * np.sin(20.0 * time)
    runs = [make_run(amplitude) for amplitude in (swing, -swing, swing, 0.0)]
    result = envelope(gather([*runs, make_run(swing, status="collapsed", end=1.0)]), LIMIT)
    assert result["still_moving"].sel(marker="block-1-face") == share
    assert is_moving(result, "block-1-face") == (share > 0.0)
    assert not is_moving(result, "slab-face")


def test_what_noise_and_a_twentieth_of_the_peak_make_is_no_motion():
    time = np.linspace(0.0, 4.0, 401)
    curve = xr.DataArray(2e-3 * np.sin(20.0 * time), {"time": time})  # 4 mm from end to end
    assert still_moves(curve, 0.079)
    assert not still_moves(curve, 0.081)
    assert not still_moves(curve, 0.0, noise=0.51e-3)


def test_where_nothing_contributes_there_is_no_value(make_run, gather):
    every_run_stopped = envelope(gather([make_run(0.1, status="collapsed", end=1.0)] * 3), LIMIT)
    assert np.isnan(every_run_stopped["marker_envelope"].isel(time=-1)).all()
    assert every_run_stopped["contributing"][-1] == 0
    none_counts = envelope(gather([make_run(0.1, status="diverged")] * 3), LIMIT)
    assert np.isnan(none_counts["marker_displacement"]).all()
    assert none_counts.attrs["counted"] == 0


def test_quantiles_are_numpys_with_nan_left_out():
    generator = np.random.default_rng(8)
    values = generator.normal(size=(13, 40))
    values[generator.uniform(size=values.shape) < 0.3] = np.nan
    probabilities = xr.DataArray([0.0, 0.05, 0.5, 0.95, 1.0], dims="quantile")
    ours = over_samples(xr.DataArray(values, dims=("sample", "time")), probabilities)
    np.testing.assert_allclose(ours, np.nanquantile(values, probabilities, axis=0), rtol=0.0, atol=1e-14)


def test_every_variable_has_a_name_and_a_unit(make_run, gather):
    result = envelope(gather([make_run(0.01), make_run(0.02)]), LIMIT)
    for name, variable in result.data_vars.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name


@pytest.mark.parametrize(
    ("failed", "collapse", "beyond"),
    [
        (0, [0.0252, 0.5561], [0.1871, 0.8129]),
        # one failed: the lower limit is that of 2 and 5 of 11, the upper one that of 3 and 6 of 11
        (1, [0.0228, 0.6097], [0.1675, 0.8325]),
    ],
)
def test_probabilities_count_collapses_as_too_much_drift(failed, collapse, beyond, make_run, gather):
    """Two collapsed and three that drifted too far of ten; limits from tables of Clopper and Pearson (1934)."""
    runs = [make_run(0.5) for _ in range(3)] + [make_run(0.1) for _ in range(5)]
    runs += [make_run(0.05, status="collapsed", end=1.0) for _ in range(2)]
    result = envelope(gather([*runs, *[make_run(9.0, status="diverged")] * failed]), LIMIT)
    assert float(result["collapse_probability"]) == 0.2
    np.testing.assert_allclose(result["collapse_probability_interval"], collapse, atol=5e-5)
    drift = result.sel(marker="block-1-face")
    assert float(drift["drift_probability"]) == 0.5
    np.testing.assert_allclose(drift["drift_probability_interval"], beyond, atol=5e-5)
    np.testing.assert_array_equal(result["largest_drift"], LIMIT)
    # the slab's marker does not drift, but a fall is one of everything
    assert float(result["drift_probability"].sel(marker="slab-face")) == 0.2


def test_a_sample_that_still_falls_is_not_counted_as_standing(make_run, gather):
    """It counts as a collapse and as a drift beyond the limit, and has no displacement at rest."""
    runs = [make_run(0.01) for _ in range(7)] + [make_run(0.05, status="falling") for _ in range(3)]
    result = envelope(gather(runs), LIMIT)
    assert result.attrs["counted"] == 10
    assert float(result["collapse_probability"]) == 0.3
    # of Clopper and Pearson, 3 of 10
    np.testing.assert_allclose(result["collapse_probability_interval"], [0.0667, 0.6525], atol=5e-5)
    block = result.sel(marker="block-1-face")
    assert float(block["drift_probability"]) == 0.3
    np.testing.assert_allclose(block["residual"].sel(frame="slab"), 0.01, atol=ROUNDING)
    # what it did until then is in the bands
    assert float(block["peak"].sel(frame="slab", quantile=0.95)) == pytest.approx(0.05, abs=ROUNDING)


def test_limits_of_quantiles_stand_beside_them(make_run, gather):
    generator = np.random.default_rng(2)
    result = envelope(gather([make_run(level) for level in generator.normal(0.02, 0.001, 50)]), LIMIT)
    peak = result["peak"].sel(frame="slab", marker="block-1-face")
    low, high = (
        result["peak_interval"].sel(frame="slab", marker="block-1-face", bound=one)
        for one in ("lower", "upper")
    )
    # fifty samples bear limits of the median and the quartiles, not of the quantiles 5 and 95 %
    borne = np.isfinite(low).to_numpy()
    np.testing.assert_array_equal(borne, [False, True, True, True, False])
    np.testing.assert_array_equal(borne, np.isfinite(high))
    assert ((low < peak) & (peak < high))[borne].all()
    # the median's deviation is sqrt(pi / 2) sigma / sqrt(n) = 0.177 mm; four of them wide, to a factor of two
    width = float((high - low).sel(quantile=0.5))
    assert 0.5 < width / (3.92 * 0.177e-3) < 2.0
    for name in ("peak", "residual", "peak_rotation", "collapse_probability", "drift_probability"):
        assert result[name].attrs["ancillary_variables"] in result


def test_nobody_counted_has_no_probability(make_run, gather):
    result = envelope(gather([make_run(0.1, status="diverged")] * 3), LIMIT)
    assert np.isnan(result["collapse_probability"])
    np.testing.assert_array_equal(result["collapse_probability_interval"], [0.0, 1.0])
    assert np.isnan(result["peak_interval"]).all()


@pytest.mark.parametrize("at_hand", [1, 2**25])
def test_files_read_some_markers_at_a_time_give_the_same(at_hand, make_run, gather, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_AT_HAND", at_hand)
    runs = [make_run(level) for level in (0.01, 0.03, 0.02)]
    together = gather([*runs, make_run(0.5, status="collapsed", end=1.0)])
    paths = [tmp_path / "second.nc", tmp_path / "first.nc"]
    for path, samples in zip(paths, ([2, 3], [0, 1]), strict=True):
        write_dataset(path, together.sel(sample=samples), DECIMALS)
    read = envelope(join_batches(paths), [np.nan, LIMIT])
    xr.testing.assert_identical(envelope_of_case(paths, LIMIT, "configuration-1"), read)
    np.testing.assert_array_equal(read["contributing"][[0, -1]], [4, 3])
