import numpy as np
import pytest
import xarray as xr
from similar_velocity import TOLERANCES, read_at_similar_velocity

STEP, ARRIVALS, HEIGHT = 1e-3, np.array([1e-3, 1.5e-3, 2.0e-3]), 4.0  # m/s, s, m


def waves(shares, target=4000.0):
    """Tests of one direction whose blocks set out at their arrivals with these shares of the step's velocity."""
    time = np.arange(0.0, 5e-3, 1e-5)
    moving = time[:, None] >= ARRIVALS - 1e-9
    speed = STEP * np.asarray(shares)
    return xr.Dataset(
        {
            "velocity": (("direction", "time", "block"), (moving * speed)[None]),
            "displacement": (
                ("direction", "time", "block"),
                (moving * speed * (time[:, None] - ARRIVALS))[None],
            ),
            "arrival": (("direction", "block"), ARRIVALS[None]),
            "wave_speed": ("direction", [HEIGHT / (ARRIVALS[-1] - ARRIVALS[0])]),
            "target_wave_speed": ("direction", [target]),
        },
        coords={"direction": ["normal"], "time": time, "block": ["low", "middle", "high"]},
        attrs={"step_velocity": STEP},
    )


def test_equal_slopes_give_the_lag_of_the_arrivals_at_any_tolerance():
    found = read_at_similar_velocity(waves([1.0, 1.0, 1.0])).sel(direction="normal")
    assert found["within"].values.tolist() == list(TOLERANCES)
    assert found["time"].values == pytest.approx(2e-3)
    assert found["wave_speed"].values == pytest.approx(4000.0)
    assert found["stiffness_ratio"].values == pytest.approx(1.0)


def test_stiffness_goes_with_the_square_of_the_speeds():
    found = read_at_similar_velocity(waves([1.0, 1.0, 1.0], target=2000.0))
    assert found["stiffness_ratio"].values == pytest.approx(0.25)


def test_slopes_that_stay_apart_are_read_where_the_tolerance_lets_them():
    found = read_at_similar_velocity(waves([1.0, 1.0, 0.85])).sel(direction="normal")
    assert np.isnan(found["wave_speed"].sel(within=0.1))
    # the lowest block is 1 um ahead when the highest sets out; the lag is that of the mean slope
    lag = 1e-6 / (STEP * np.mean([1.0, 1.0, 0.85]))
    assert float(found["wave_speed"].sel(within=0.2)) == pytest.approx(HEIGHT / lag, rel=1e-6)
