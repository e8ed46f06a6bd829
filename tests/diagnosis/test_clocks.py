"""The clock of a laboratory changes no step of a diagnosis: its zero, its rate, and where the command begins in it."""

import numpy as np
import pytest
import xarray as xr
from tiny_campaign import write_campaign
from tiny_diagnosis import a_formula, simulate_open_tests

from blockshake.diagnosis import steps
from blockshake.diagnosis.misfit.judged_test import measured_histories
from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.files import PACKAGE, write_dataset
from blockshake.measurement.campaigns.campaign import load_campaign

STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"
WEAK = {"name": "weak-joint", "values": {"factor": 0.5}, "place": {"joint": ["block-1", "block-2"]}}


def _rewritten(folder, change):
    """Change every test of a campaign's folder."""
    for path in sorted(folder.glob("*.nc")):
        test = xr.load_dataset(path)
        path.unlink()
        write_dataset(path, change(test))


def _moved(by):
    return lambda test: test.assign_coords(time=test["time"] + by)


def _read_before(length):
    """The table rests, and is read, for so long before the command [s]."""

    def change(test):
        count = round(length * 200.0)
        noise = np.random.default_rng(7).normal(0.0, 1e-4, (count, *test["marker_displacement"].shape[1:]))
        rest = test.isel(time=slice(0, 1)).isel(time=np.zeros(count, dtype=int))
        rest = rest.assign_coords(time=test["time"].to_numpy()[:1] - np.arange(count, 0, -1) / 200.0)
        rest["marker_displacement"] = rest["marker_displacement"].copy(data=noise)
        whole = xr.concat([rest, test], dim="time", data_vars="minimal")
        whole["marker_displacement"] -= whole["marker_displacement"].isel(time=0, drop=True)
        return whole

    return change


def _read_after(length):
    """The first readings are missing; displacements count from the first that is there."""

    def change(test):
        kept = test.sel(time=slice(length, None))
        kept["marker_displacement"] -= kept["marker_displacement"].isel(time=0, drop=True)
        return kept

    return change


def _read_at(every):
    return lambda test: test.isel(time=slice(None, None, every))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clocks")
    write_campaign(folder, STRUCTURE, WEAK)
    return folder


def _copy(campaign, folder, change):
    folder.mkdir()
    for path in campaign.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    _rewritten(folder, change)
    return str(folder)


def _measured(folder):
    return measured_histories(load_campaign(folder), ["one-100", "two-100"], [])


@pytest.mark.parametrize("zero", [-3.0, 0.5, 30.0, 43200.0, 1.7e9])
def test_a_clock_that_starts_elsewhere_reads_the_same(campaign, tmp_path, zero):
    """Histories, and all that the ensembles are simulated from, to the bit."""
    moved = _copy(campaign, tmp_path / "moved", _moved(zero))
    here, there = _measured(str(campaign)), _measured(moved)
    for name in here:
        xr.testing.assert_identical(there[name], here[name])
    with a_formula():
        one, other = (plan_diagnosis(folder, "tiny") for folder in (str(campaign), moved))
    digests, others = ([test.digest for test in plan.tests.values()] for plan in (one, other))
    assert digests == others


@pytest.fixture(scope="module")
def misfit(campaign, tmp_path_factory):
    """Misfit of the campaign."""
    with a_formula():
        return steps.describe_misfit(*_simulated(campaign, tmp_path_factory.mktemp("of-here")))


def _simulated(folder, runs):
    return str(folder), "tiny", simulate_open_tests(runs, str(folder))


@pytest.mark.parametrize(
    "change",
    [_read_before(1.5), _read_after(0.4), _read_at(2)],
    ids=["1.5 s before the command", "0.4 s after the command", "100 Hz"],
)
def test_the_misfit_is_the_same_wherever_the_command_begins_and_at_another_rate(
    campaign, misfit, tmp_path, change
):
    (tmp_path / "runs").mkdir()
    with a_formula():
        there = steps.describe_misfit(
            *_simulated(_copy(campaign, tmp_path / "there", change), tmp_path / "runs")
        )
    assert there.attrs["where"].partition(" in ")[0] == misfit.attrs["where"].partition(" in ")[0]
    assert float(there["p"]) == float(misfit["p"])
    assert there["measured"].notnull().any()


def test_readings_before_the_command_are_left_out(campaign, tmp_path):
    """But for the last one, within a step of the command; what is read is what the test without them tells."""
    before = _measured(_copy(campaign, tmp_path / "before", _read_before(1.5)))
    here = _measured(str(campaign))
    for name, one in here.items():
        assert abs(before[name].sizes["time"] - one.sizes["time"]) <= 1
        assert 0.0 <= before[name]["time"][0] <= 0.02
        times = np.intersect1d(before[name]["time"], one["time"])
        error = before[name]["drift"].sel(time=times) - one["drift"].sel(time=times)
        assert np.abs(error).max() < 1e-3


def test_tests_at_another_rate_are_read_as_often(campaign, tmp_path):
    folder = _copy(campaign, tmp_path / "slow", _read_at(2))
    for one in _measured(folder).values():
        np.testing.assert_allclose(np.diff(one["time"]), 0.02, atol=1e-9)
