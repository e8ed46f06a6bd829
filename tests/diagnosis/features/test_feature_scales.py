import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.features.feature_scales import signed_log


def test_signed_logarithm_is_linear_near_zero_and_odd():
    names = ["joint1.slip.peak+", "joint2.slip.peak-", "joint1.slip.residual", "joint1.pivot+"]
    values = xr.DataArray([1e-6, -1e-6, 0.1, 0.4], {"feature": names}, "feature")
    found = signed_log(values).to_numpy()
    assert found[0] == pytest.approx(1e-3, rel=1e-3)
    assert found[1] == -found[0]
    assert found[2] == pytest.approx(np.log(101.0))
    assert found[3] == 0.4
