import numpy as np
import xarray as xr

from blockshake.diagnosis.misfit.ranking import strongest_test, worst_curves, worst_joints


def test_joints_with_the_largest_residuals_come_from_the_lowest_up():
    residual = np.zeros((1, 1, 1, 2, 4))
    residual[..., 1, :] = [3.0, -9.0, 1.0, 4.0]
    misfit = xr.Dataset(
        {"residual": (("test", "phase", "quantity", "side", "joint"), residual)},
        coords={"joint": ["j1", "j2", "j3", "j4"]},
    )
    assert worst_joints(misfit, 2) == ["j2", "j4"]


def test_curves_rank_by_their_score_over_the_reference_and_unknown_ones_do_not_count():
    misfit = xr.Dataset(
        {
            "crps": ("curve", [2.0, 3.0, np.nan]),
            "crps_reference": (("curve", "reference"), [[0.5, 0.5], [0.5, 3.0], [0.5, 1.0]]),
            "coverage": ("curve", [0.4, 0.9, 0.1]),
            "coverage_reference": (("curve", "reference"), [[0.5, 0.9]] * 3),
        },
        coords={"curve": ["a", "b", "c"], "reference": [0.05, 0.5]},
    )
    assert worst_curves(misfit, 1) == (["a"], 2, 1)


def test_the_strongest_test_has_the_largest_drift_of_either_sign():
    drift = np.array([[0.1, 0.2], [-0.5, np.nan]])[:, :, None]
    readings = xr.Dataset(
        {"drift": (("test", "time", "body"), drift)}, coords={"test": ["weak", "strong"], "body": ["top"]}
    )
    assert strongest_test(readings, "top") == "strong"
