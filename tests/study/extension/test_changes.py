"""Changes by a cause, from runs whose drift is known."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from blockshake.statistics.intervals import share_interval
from blockshake.study.extension.changes import changes, with_fragility

TIME = np.arange(401) / 200.0
SAMPLES = 12
SWAY = np.sin(2.0 * np.pi * TIME)


@pytest.fixture
def pair(make_run, gather):
    """Ensembles without and with a cause that adds 10 mm to every drift; the last sample falls with the cause alone."""

    def made(more=0.010, falls=True):
        sizes = 0.020 + 0.001 * np.arange(SAMPLES)
        without = [make_run(size * SWAY, angle=size) for size in sizes]
        extended = [make_run((size + more) * SWAY, angle=size + more) for size in sizes]
        if falls:
            extended[-1] = make_run((sizes[-1] + more) * SWAY, status="collapsed", end=1.5)
        return gather(without), gather(extended)

    return made


def test_the_same_samples_differ_by_what_the_cause_adds(pair):
    at = changes({"ls-dem": pair(falls=False)}, None).sel(model="ls-dem")
    assert int(at["paired"]) == SAMPLES
    for quantity in ("median_drift", "drift"):
        change = at.sel(quantity=quantity, side="change")
        assert_allclose(change["value"], 0.010, atol=1e-12)
        # every pair differs by as much: no draw of pairs has another change
        assert_allclose(change["value_interval"], 0.010, atol=1e-12)
    change = at.sel(side="change")
    assert_allclose(change["value"].sel(quantity="uplift"), 0.4 * 0.010)  # half the width times the angle
    assert float(change["value"].sel(quantity="collapse")) == 0.0
    low, high = change["value_interval"].sel(quantity="collapse").values
    assert low < 0.0 < high
    assert np.isnan(change["value"].sel(quantity="safe_scale"))


def test_no_cause_changes_nothing(pair):
    at = changes({"ls-dem": pair(0.0, falls=False)}, None).sel(model="ls-dem")
    change = at.sel(side="change").drop_sel(quantity="safe_scale")
    assert (change["value"] == 0.0).all()
    assert (change["value_interval"].sel(bound="lower") <= 0.0).all()
    assert (change["value_interval"].sel(bound="upper") >= 0.0).all()


def test_shares_have_their_exact_limits(pair):
    at = changes({"ls-dem": pair()}, None).sel(model="ls-dem", quantity="collapse")
    assert float(at["value"].sel(side="extended")) == pytest.approx(1.0 / SAMPLES)
    assert_allclose(at["value_interval"].sel(side="extended"), share_interval(1, SAMPLES))
    assert_allclose(at["value_interval"].sel(side="without"), share_interval(0, SAMPLES))
    # Zou and Donner (2008), Eq. (4): from the limits of both shares of samples that fall in one alone
    (low_a, high_a), (low_b, high_b) = share_interval(0, SAMPLES), share_interval(1, SAMPLES)
    share = 1.0 / SAMPLES
    expected = [share - np.hypot(share - low_b, high_a), share + np.hypot(high_b - share, 0.0 - low_a)]
    assert_allclose(at["value_interval"].sel(side="change"), expected)


def test_naming_the_cause_gains_all_there_is_where_the_record_is_one_of_its_members(
    pair, read_with_noise, make_run
):
    without, extended = pair(falls=False)
    truth = read_with_noise(make_run((0.0255 + 0.010) * SWAY), 1e-5, 3)
    at = changes({"ls-dem": (without, extended)}, truth).sel(model="ls-dem")
    score = at["score"].sel(kind=["without", "extended"]).values
    assert score[1] < score[0]
    assert float(at["gain"]) > 0.9
    assert float(at["gain_interval"][0]) > 0.5


def test_nothing_is_gained_where_the_record_is_a_member_without_the_cause(pair, read_with_noise, make_run):
    truth = read_with_noise(make_run(0.0255 * SWAY), 1e-5, 3)
    at = changes({"ls-dem": pair(0.0, falls=False)}, truth).sel(model="ls-dem")
    assert np.isnan(at["gain"])
    # a cause that is not there loses
    lost = changes({"ls-dem": pair(falls=False)[::-1]}, truth).sel(model="ls-dem")
    assert float(lost["gain"]) > 0.9  # the other way round it is found again


def test_too_few_pairs_have_no_gain(make_run, gather, read_with_noise):
    two = gather([make_run(0.02 * SWAY), make_run(0.03 * SWAY)])
    truth = read_with_noise(make_run(0.05 * SWAY), 1e-5, 3)
    assert np.isnan(changes({"ls-dem": (two, two)}, truth)["gain"]).all()


def test_safe_scales_stand_beside_each_other(pair):
    def fragility(value, low, high, dispersion=0.2):
        limits = xr.DataArray([low, high], dims="bound", coords={"bound": ["lower", "upper"]})
        ends = {"capacity_lower": ("sample", [1.5, 2.0]), "capacity_upper": ("sample", [2.5, 3.0])}
        return xr.Dataset(
            {"safe_scale": value, "safe_scale_interval": limits, "dispersion": dispersion, **ends}
        )

    found = changes({"ls-dem": pair()}, None)
    of = with_fragility(found, "ls-dem", fragility(2.0, 1.8, 2.3), fragility(1.5, 1.1, 1.7))
    at = of.sel(model="ls-dem", quantity="safe_scale", side="change")
    assert float(at["value"]) == -0.5
    assert_allclose(at["value_interval"], [-0.5 - np.hypot(0.4, 0.3), -0.5 + np.hypot(0.2, 0.2)])
    # all capacities between two levels: these are the limits
    alike = with_fragility(found, "ls-dem", fragility(2.2, np.nan, np.nan, 0.0), fragility(1.5, 1.1, 1.7))
    without = alike.sel(model="ls-dem", quantity="safe_scale", side="without")
    assert_allclose(without["value_interval"], [2.0, 2.5])
