import numpy as np
import pytest
import xarray as xr

from blockshake.study.ensembles.ensemble import measured_curves

TIME = np.arange(0.0, 2.001, 0.01)


def test_measured_extremes_are_of_the_window_and_relative_to_the_slab():
    slab, block = 0.02 * TIME, 0.05 * TIME
    moved = np.zeros((len(TIME), 2, 3))
    moved[:, 0, 0], moved[:, 1, 0] = slab, block
    moved[95, 1, 0] = np.nan  # a gap, left out
    test = xr.Dataset(
        {"marker_displacement": (("time", "marker", "axis"), moved)},
        coords={"time": TIME, "marker": ["slab", "block"], "axis": ["x", "y", "z"]},
    )
    found = measured_curves(test, "slab", 1.0).sel(marker="block")
    assert float(found["time"][-1]) == pytest.approx(1.0, abs=1e-12)
    assert float(found["peak"].sel(frame="slab")) == pytest.approx(0.03, rel=1e-12)
    assert float(found["peak"].sel(frame="inertial")) == pytest.approx(0.05, rel=1e-12)
    # the mean over the last half second, but for the gap at 0.95 s
    times = np.delete(TIME[50:101], 45)
    assert float(found["residual"].sel(frame="inertial")) == pytest.approx(0.05 * times.mean(), rel=1e-12)
