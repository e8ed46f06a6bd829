import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fake_study import ensemble_of

from blockshake.errors import InputError
from blockshake.files import write_dataset
from blockshake.study.ensembles.ensemble import (
    RESIDUAL_WINDOW,
    join_batches,
    relative_to_slab,
    sample_figures,
)

ROUNDING = 1e-12  # m


def test_runs_stand_side_by_side_with_their_parameters(make_run):
    design = pd.DataFrame(
        {"friction.concrete.concrete": [0.6, 0.7, 0.8], "materials.concrete.density": 2400.0}
    )
    runs = [make_run(0.01), make_run(0.02)]
    ensemble = ensemble_of(runs, design.loc[[0, 2]])
    assert ensemble["marker_displacement"].dims == ("sample", "time", "marker", "axis")
    assert ensemble["position"].dims == ("sample", "time", "body", "axis")
    np.testing.assert_array_equal(ensemble["sample"], [0, 2])
    np.testing.assert_array_equal(
        ensemble["marker_displacement"].sel(sample=0).transpose("time", "marker", "axis"),
        runs[0]["marker_displacement"],
    )
    np.testing.assert_array_equal(ensemble["parameter_value"], [[0.6, 2400.0], [0.8, 2400.0]])
    assert list(ensemble["parameter_unit"].values) == ["1", "kg/m3"]
    # what all runs share, not what is one run's
    assert ensemble.attrs["model"] == "ls-dem"
    assert not {"sample", "status", "end_time"} & set(ensemble.attrs)


def test_peak_residual_and_rotation_of_known_curves(make_run, gather):
    time = make_run(0.0)["time"].to_numpy()
    swing = np.where(time < 1.0, -0.05 * np.sin(np.pi * time), 0.02)
    ensemble = gather([make_run(swing, slab=0.3, angle=0.04), make_run(0.0)])
    peak, residual = (
        ensemble["peak"].sel(marker="block-1-face"),
        ensemble["residual"].sel(marker="block-1-face"),
    )
    assert peak.sel(sample=0, frame="slab") == pytest.approx(0.05, abs=ROUNDING)
    assert peak.sel(sample=0, frame="inertial") == pytest.approx(0.32, abs=ROUNDING)
    assert residual.sel(sample=0, frame="slab") == pytest.approx(0.02, abs=ROUNDING)
    assert residual.sel(sample=0, frame="inertial") == pytest.approx(0.32, abs=ROUNDING)
    # the arccosine near 1 keeps half the digits
    np.testing.assert_allclose(ensemble["peak_rotation"].sel(sample=0), [0.0, 0.04], atol=1e-7)
    np.testing.assert_array_equal(peak.sel(sample=1), 0.0)
    np.testing.assert_allclose(ensemble["joint_uplift"].sel(joint="slab-block-1"), [0.016, 0.0])
    np.testing.assert_allclose(ensemble["joint_slip"].sel(joint="slab-block-1"), [0.05, 0.0], atol=ROUNDING)


def test_a_run_cut_short_keeps_its_peak_and_has_no_residual(make_run, gather):
    late = make_run(0.0)["time"].to_numpy()[-1] - RESIDUAL_WINDOW / 2
    ensemble = gather(
        [make_run(0.03, status="collapsed", end=1.0), make_run(0.03, status="collapsed", end=late)]
    )
    chosen = ensemble.sel(marker="block-1-face", frame="slab")
    np.testing.assert_allclose(chosen["peak"], 0.03, atol=ROUNDING)
    assert np.isnan(chosen["residual"]).all()
    assert list(ensemble["status"].values) == ["collapsed", "collapsed"]
    assert list(ensemble["reason"].values) == ["fell", "fell"]
    np.testing.assert_array_equal(ensemble["end_time"], [1.0, late])


def test_relative_displacement_takes_the_slab_away(make_run):
    run = make_run(0.01, slab=0.2)
    relative = relative_to_slab(run["marker_displacement"], "slab-face")
    np.testing.assert_array_equal(relative.sel(marker="slab-face"), 0.0)
    np.testing.assert_allclose(relative.sel(marker="block-1-face", axis="x")[1:], 0.01, atol=ROUNDING)


def test_batches_join_to_the_ensemble_gathered_at_once(make_run, tmp_path):
    design = pd.DataFrame({"friction.concrete.concrete": [0.5, 0.6, 0.7, 0.8]})
    runs = [make_run(0.01 * k, status="collapsed" if k == 3 else "completed") for k in range(4)]
    runs[0].attrs["numerics_steps"] = 7
    for samples in ([2, 3], [0, 1]):
        batch = ensemble_of([runs[k] for k in samples], design.loc[samples])
        write_dataset(tmp_path / f"{samples[0]}.nc", batch)
    joined = join_batches([tmp_path / "2.nc", tmp_path / "0.nc"])
    at_once = ensemble_of(runs, design)
    xr.testing.assert_equal(joined, at_once)
    assert joined.attrs == at_once.attrs
    with pytest.raises(InputError, match="every sample in one only"):
        join_batches([tmp_path / "2.nc", tmp_path / "2.nc"])
    with pytest.raises(InputError, match="at least one batch"):
        join_batches([])
    with pytest.raises(InputError, match="same 'parameter'"):
        join_batches(
            [at_once.isel(sample=[0]), at_once.isel(sample=[1]).assign_coords(parameter=["restitution"])]
        )


def test_figures_of_the_samples_leave_the_histories_out(make_run, gather):
    figures = sample_figures(gather([make_run(0.01), make_run(0.02)]))
    assert "time" not in figures.dims
    assert {"status", "reason", "peak", "residual", "peak_rotation", "end_time"} <= set(figures.data_vars)
    np.testing.assert_array_equal(figures["parameter_value"], [[0.5], [0.51]])


def test_figures_of_the_computation_stand_along_the_samples(make_run, gather):
    runs = [make_run(0.01), make_run(0.02)]
    runs[0].attrs |= {"energy_residual": 1e-3, "numerics_steps": 400, "motion": "alkion", "parameters": "{}"}
    runs[1].attrs |= {"energy_residual": 2e-3, "motion": "alkion", "parameters": "{}"}
    ensemble = gather(runs)
    np.testing.assert_array_equal(ensemble["energy_residual"], [1e-3, 2e-3])
    np.testing.assert_array_equal(ensemble["numerics_steps"], [400.0, np.nan])
    assert ensemble.attrs["motion"] == "alkion"
    assert not {"numerics_steps", "energy_residual", "parameters"} & set(ensemble.attrs)


def test_every_quantity_has_a_name_and_a_unit(make_run, gather):
    ensemble = gather([make_run(0.01)])
    for name in ("peak", "residual", "peak_rotation", "end_time"):
        assert ensemble[name].attrs["units"]
        assert ensemble[name].attrs["long_name"]


def test_runs_that_do_not_belong_together_are_refused(make_run, gather):
    run = make_run(0.01)
    with pytest.raises(InputError, match="sample 1: expected the same 'time'"):
        gather([run, run.isel(time=slice(0, 100))])
    with pytest.raises(InputError, match="same 'marker'"):
        gather([run, run.assign_coords(marker=["slab-face", "top"])])


def test_joined_texts_keep_their_length_through_a_file(tmp_path):
    """A text read from a file must not cut longer ones joined to it: short status first, long after."""
    for sample, status in enumerate(("ok", "not-converged")):
        part = xr.Dataset(
            {
                "marker_displacement": (("sample", "time", "marker", "axis"), np.zeros((1, 2, 1, 1))),
                "status": ("sample", [status]),
            },
            coords={
                "sample": [sample],
                "time": [0.0, 1.0],
                "marker": ["m"],
                "body": ["b"],
                "joint": ["j"],
                "parameter": ["p"],
            },
        )
        write_dataset(tmp_path / f"{sample}.nc", part)
    write_dataset(tmp_path / "joined.nc", join_batches([tmp_path / "0.nc", tmp_path / "1.nc"]))
    assert list(xr.load_dataset(tmp_path / "joined.nc")["status"].values) == ["ok", "not-converged"]
