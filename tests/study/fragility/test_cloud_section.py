"""Blocks on drawn motions: both fragilities in a table, with what the samples do not tell."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from blockshake.study.fragility.cloud_section import cloud_blocks

NAMES = ("median", "dispersion", "safe")


def made_cloud(weight=0.5, measure="sa"):
    """Twelve samples at two levels, of which three fail; the counts tell no limits."""
    fine = np.geomspace(1.0, 4.0, 5)
    values = {name: ("fit", [2.0, np.nan]) for name in NAMES}
    values |= {f"{name}_interval": (("fit", "bound"), [[1.5, np.inf], [np.nan, np.nan]]) for name in NAMES}
    curve = np.linspace(0.0, 1.0, 5)
    return xr.Dataset(
        {
            **values,
            "curve": (("fit", "fine_intensity"), [curve, curve]),
            "curve_interval": (("fit", "bound", "fine_intensity"), np.full((2, 2, 5), 0.5)),
            "intensity": ("sample", np.tile([1.0, 4.0], 6)),
            "demand": ("sample", np.linspace(0.01, 0.3, 12)),
            "largest_drift": ("sample", [0.24] * 12),
            "fell": ("sample", [0] * 11 + [1]),
        },
        {"fit": ["regression", "counts"], "bound": ["lower", "upper"], "fine_intensity": fine},
        {
            "measure": measure, "period": 0.5, "levels": 2, "records": 3, "weight": weight, "slope": 1.5,
            "intercept": -1.0,
        },
    )  # fmt: skip


def content(cloud, given=None):
    response = SimpleNamespace(cloud=cloud)
    cases = {"wall": SimpleNamespace(responses={"nscd-rigid": response})}
    return SimpleNamespace(cases=cases, study={"ladder": {"largest_drift": given}})


def test_a_case_without_drawn_motions_has_no_blocks():
    assert cloud_blocks(content(None)) == []


@pytest.mark.parametrize("given", [0.4, {"high": 0.2, "low/high": 0.1}])
def test_a_limit_of_a_joint_is_named(given):
    _, words, *_ = cloud_blocks(content(made_cloud(), given))
    assert ("or a joint slips by more than its own" in words.text) == isinstance(given, dict)


def test_both_fragilities_stand_in_the_table():
    *_, table = cloud_blocks(content(made_cloud()))
    regression, counts = table.rows
    assert regression[2:6] == ("3", "3 of 12", "cloud (regression)", "Sa(0.5 s) [m/s²]")
    assert regression[6] == "2 [1.50, no limit]"
    assert counts[6] == "none"


@pytest.mark.parametrize(("weight", "told"), [(0.5, True), (1.0, False)])
def test_records_that_repeat_are_told(weight, told):
    words = cloud_blocks(content(made_cloud(weight)))[1]
    assert ("count together as one" in str(words)) == told


def test_a_peak_velocity_has_its_unit():
    *_, table = cloud_blocks(content(made_cloud(measure="pgv")))
    assert table.rows[0][5] == "PGV [m/s]"
