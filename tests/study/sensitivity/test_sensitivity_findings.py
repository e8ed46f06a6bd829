import numpy as np
import pytest
import xarray as xr

from blockshake.study.sensitivity.findings import (
    differs,
    influences,
    is_known,
    quiet_markers,
)

NAMES = ["a", "b", "c"]


def result(values, measure="first_order", chance=0.3):
    values = np.asarray(values)
    return xr.Dataset(
        {
            measure: ("parameter", values),
            f"{measure}_interval": (("bound", "parameter"), np.stack([values - 0.1, values + 0.2])),
            f"{measure}_chance": ((), chance),
            "control": ("parameter", [0, 0, 1]),
            "spread": ((), 2e-3),
        },
        coords={"parameter": NAMES, "bound": ["lower", "upper"]},
    )


def test_variables_are_ranked_by_their_share_and_a_negative_share_is_last():
    found = influences(result([-0.9, 0.5, 0.31]), "first_order")
    assert [one.parameter for one in found] == ["b", "c", "a"]
    assert [one.parameter for one in found if one.beyond_chance] == ["b", "c"]
    assert found[0][2:5] == pytest.approx((0.5, 0.4, 0.7))
    assert found[1].control


def test_variables_are_ranked_by_the_magnitude_of_their_correlation():
    found = influences(result([-0.9, 0.5, 0.3], "rank_correlation"), "rank_correlation")
    assert [one.parameter for one in found] == ["a", "b", "c"]
    assert [one.beyond_chance for one in found] == [True, True, False]  # 0.3 is not beyond 0.3


def test_what_is_not_known_differs_from_nothing():
    assert differs(result([0.0] * 3), 2e-3)
    assert not differs(result([0.0] * 3), 2.1e-3)
    assert not differs(result([0.0] * 3).assign(spread=np.nan), 1e-9)
    assert is_known(result([0.0] * 3), "first_order")
    assert not is_known(result([0.0] * 3, chance=np.nan), "first_order")


def test_quiet_markers_have_a_known_spread_below_the_noise():
    spread = xr.Dataset(
        {"spread": (("quantity", "marker"), [[1e-5, 1e-3, np.nan]])},
        coords={"quantity": ["history"], "marker": ["x", "y", "z"]},
    )
    assert quiet_markers(spread, ["x", "y", "z"], 1e-4) == 1
