import numpy as np
import pytest
import xarray as xr

from blockshake.files import write_dataset
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.study.ensembles.shown_samples import FRAME_RATE, shown_markers, shown_of_case, shown_samples

ROUNDING = 1e-12  # m


@pytest.fixture
def ensemble(make_run, gather):
    """Four runs of different peaks; the third failed, and the last one collapsed after a second."""
    runs = [make_run(0.03, slab=0.2, angle=0.04), make_run(0.01), make_run(0.09, status="failed")]
    return gather([*runs, make_run(0.02, status="collapsed", end=1.0)])


def test_median_and_largest_of_the_samples_that_count_are_shown(ensemble):
    shown = shown_samples(ensemble)
    assert list(zip(shown["sample"].values, shown["chosen"].values, strict=True)) == [
        (0, "median"),
        (3, "worst"),  # it fell
    ]
    np.testing.assert_allclose(shown["peak"], [0.03, 0.02], atol=ROUNDING)


def test_motion_is_relative_to_the_slab_since_the_start(ensemble):
    shown = shown_samples(ensemble).sel(sample=0)
    assert np.diff(shown["time"]) == pytest.approx(1.0 / FRAME_RATE)
    shift = shown["shift"].sel(body="block-1").transpose("time", "axis")
    np.testing.assert_allclose(shift[1:], np.tile([0.03, 0.0, 0.0], (len(shift) - 1, 1)), atol=ROUNDING)
    turn = shown["turn"].sel(body="block-1", axis="y")
    np.testing.assert_allclose(turn, 0.04 * shown["time"] / shown["time"][-1], atol=ROUNDING)


def test_run_that_ended_early_stands_still(ensemble):
    shown = shown_samples(ensemble).sel(sample=3, body="block-1", axis="x")
    np.testing.assert_allclose(shown["shift"][1:], 0.02, atol=ROUNDING)


@pytest.mark.parametrize("status", ["completed", "failed"])
def test_of_files_the_samples_shown_are_the_same(make_run, gather, tmp_path, status):
    whole = gather([make_run(peak, status=status) for peak in (0.03, 0.01, 0.09, 0.02)])
    files = []
    for first in (0, 2):
        files.append(tmp_path / f"{first}.nc")
        write_dataset(files[-1], whole.isel(sample=slice(first, first + 2)))
    xr.testing.assert_identical(shown_of_case(files), shown_samples(join_batches(files)))


def test_one_sample_is_shown_once_and_none_not_at_all(make_run, gather):
    one = shown_samples(gather([make_run(0.03)]))
    assert list(one["chosen"].values) == ["the only sample"]
    assert shown_samples(gather([make_run(0.03, status="failed")])).sizes["sample"] == 0


def test_markers_are_read_at_the_frames_relative_to_the_slab(make_run):
    run = make_run(0.03, slab=0.2)
    reading = run["marker_displacement"].copy()
    reading.loc[{"marker": "block-1-face", "axis": "z"}] = np.nan  # a camera from above
    reading.loc[{"marker": "block-1-face", "axis": "x", "time": 1.0}] = np.nan
    test = xr.Dataset({"marker_displacement": reading}, attrs={"slab_marker": "slab-face"})
    shown = shown_markers(test, np.array([0.5, 1.0, 1.5])).sel(marker="block-1-face")
    np.testing.assert_allclose(shown.sel(axis="x"), [0.03, np.nan, 0.03], atol=ROUNDING)
    np.testing.assert_array_equal(shown.sel(axis="z"), 0.0)


def test_record_that_starts_within_a_frame_has_its_first_one(make_run):
    run = make_run(0.03)
    test = run[["marker_displacement"]].assign_coords(time=run["time"] + 3e-3)
    test.attrs = {"slab_marker": "slab-face"}
    shown = shown_markers(test, np.array([0.0, 1.0, 2.04])).sel(marker="block-1-face", axis="x")
    np.testing.assert_allclose(shown, [0.0, 0.03, np.nan], atol=ROUNDING)
