import numpy as np
import pytest
import xarray as xr

from blockshake.study.ensembles.outcomes import (
    count_outcomes,
    numerical_figure,
    unfinished,
)

STATUS = ["completed", "collapsed", "not-converged", "completed", "falling"]


@pytest.fixture
def samples():
    return xr.Dataset(
        {
            "status": ("sample", STATUS),
            "reason": ("sample", ["", "", "", "a remark", ""]),
            "energy_residual": ("sample", [1e-4, np.nan, 5e-4, 2e-4, np.nan]),
            "numerics_steps": ("sample", [10.0, 30.0, np.nan, 20.0, np.nan]),
        },
        coords={"sample": [3, 5, 8, 9, 11]},
    )


def test_every_sample_has_one_outcome():
    found = count_outcomes(STATUS)
    assert found == (2, 1, 1, 1)
    assert (sum(found), found.counted) == (5, 4)


def test_unfinished_samples_are_those_that_did_not_complete_or_have_a_remark(samples):
    assert [int(one["sample"]) for one in unfinished(samples)] == [5, 8, 9, 11]


def test_figures_leave_out_samples_without_one(samples):
    assert numerical_figure(samples, "energy_residual", np.median) == 2e-4
    assert numerical_figure(samples, "numerics_steps", np.max) == 30.0
    assert np.isnan(numerical_figure(samples, "numerics_capped_steps", np.max))
