import numpy as np
import pytest
import xarray as xr
from scipy.stats import kstest

from blockshake.diagnosis.feature_scales import rank_gaussian, signed_log


def test_signed_logarithm_is_linear_near_zero_and_odd():
    names = ["joint1.slip.peak+", "joint2.slip.peak-", "joint1.slip.residual", "joint1.pivot+"]
    values = xr.DataArray([1e-6, -1e-6, 0.1, 0.4], {"feature": names}, "feature")
    found = signed_log(values).to_numpy()
    assert found[0] == pytest.approx(1e-3, rel=1e-3)
    assert found[1] == -found[0]
    assert found[2] == pytest.approx(np.log(101.0))
    assert found[3] == 0.4


def test_ranks_of_the_pools_own_law_are_standard_normal():
    generator = np.random.default_rng(0)
    pool, values = generator.exponential(size=(2000, 1)) ** 3, generator.exponential(size=(400, 1)) ** 3
    assert kstest(rank_gaussian(values, pool)[:, 0], "norm").pvalue > 0.01
    assert np.isfinite(rank_gaussian(np.array([[-1.0], [1e9]]), pool)).all()
    assert rank_gaussian(np.array([[0.0]]), np.zeros((9, 1)))[0, 0] == pytest.approx(0.0)
