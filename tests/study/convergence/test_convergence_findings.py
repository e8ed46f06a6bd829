import numpy as np
import pandas as pd
import pytest

from blockshake.study.convergence.findings import (
    default_departures,
    floor_shares,
    observed_order,
    value_scales,
)
from blockshake.study.convergence.table import COLUMNS, OBSERVABLES


def table(order=2.0, floor=0.01):
    """Values 2 + setting^order, the energy residual setting^order itself; the default is the second setting."""
    rows = []
    for setting in (0.1, 0.2, 0.4):
        for name, unit in OBSERVABLES.items():
            rest = 0.0 if name == "energy_residual" else 2.0
            difference = setting**order - 0.1**order
            rows.append(
                ("time_step", setting, setting == 0.2, name, unit, rest + setting**order, difference, floor)
            )
    return pd.DataFrame(rows, columns=COLUMNS)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_order_of_a_power_law_is_its_exponent(order):
    assert observed_order(table(order), "time_step", "energy_residual") == pytest.approx(order, rel=1e-12)


def test_one_setting_has_no_order():
    found = table()
    assert np.isnan(observed_order(found[found["setting"] == 0.1], "time_step", "energy_residual"))


def test_the_default_departs_by_its_largest_share_and_counts_what_is_beyond_the_floor():
    (found,) = default_departures(table())
    assert (found.parameter, found.setting) == ("time_step", 0.2)
    assert found.share == pytest.approx(0.03, rel=1e-12)  # of the energy residual, whose scale is 1
    assert found.observable == "energy_residual"
    assert (found.beyond_floor, found.compared) == (len(OBSERVABLES), len(OBSERVABLES))
    (quiet,) = default_departures(table(floor=0.02))
    assert quiet.beyond_floor == 0


def test_a_default_that_is_the_finest_departs_from_nothing():
    found = table()
    found["usual"] = found["setting"] == 0.1
    assert default_departures(found) == []


def test_floors_are_shares_of_the_value_at_the_smallest_step():
    assert value_scales(table())["sink"] == pytest.approx(2.01, rel=1e-12)
    assert floor_shares(table())["sink"] == pytest.approx(0.01 / 2.01, rel=1e-12)
