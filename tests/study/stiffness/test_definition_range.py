import numpy as np
import pytest
import xarray as xr

from blockshake.study.stiffness.definition_range import definition_range


def definitions(peaks):
    stiffness = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]) * 1e10
    return xr.Dataset(
        {
            "stiffness": (("direction", "restitution", "definition"), np.stack([stiffness, stiffness])),
            "top_peak": (("restitution", "definition"), peaks),
            "top_peak_same_damping": (("restitution", "definition"), peaks + 0.1),
            "target_wave_speed": ("direction", [4000.0, 2000.0]),
            "free_speed": ("factor", [100.0, 500.0]),
        },
        coords={
            "direction": ["normal", "shear"], "restitution": [0.1, 0.5],
            "definition": ["50 %", "90 %", "first peak"], "factor": [1.0, 10.0],
        },
        attrs={"definition": "50 %", "study_restitution": 0.5},
    )  # fmt: skip


def test_ranges_are_relative_to_the_stiffness_of_the_study():
    found = definition_range(definitions(np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])))
    assert found.at_own_damping == pytest.approx((1.0, 1.5))
    assert found.over_levels == pytest.approx((0.25, 1.25))
    assert found.top_peak == pytest.approx((0.1, 0.7))
    assert (found.free_share, found.free_factor) == (0.25, 10.0)


def test_a_trend_is_shown_where_chance_seldom_makes_one():
    rising = definition_range(definitions(np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]))).trend
    assert rising.tau == pytest.approx(1.0, rel=1e-12)
    assert rising.p == pytest.approx(2.0 / 720.0)  # two of the orders of six values
    assert rising.shown
    mixed = definition_range(definitions(np.array([[0.3, 0.1, 0.5], [0.2, np.nan, 0.4]]))).trend
    assert not mixed.shown
