"""The clock of a laboratory changes no step of a diagnosis: its zero, its rate, and where the command begins in it."""

import numpy as np
import pytest
import xarray as xr
from tiny_campaign import write_campaign
from tiny_diagnosis import diagnose, two_effects_and_a_formula

from blockshake.diagnosis import steps
from blockshake.diagnosis.features.measured_readings import reading_of
from blockshake.diagnosis.laws.measured_forces import forces_of
from blockshake.diagnosis.libraries.plan import plan_diagnosis
from blockshake.files import PACKAGE, write_dataset

STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"
PITCH = {"name": "table-pitch", "values": {"coefficient": 1.2e-3, "frequency": 18.0}, "place": {}}


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
    write_campaign(folder, STRUCTURE, PITCH)
    return folder


def _copy(campaign, folder, change):
    folder.mkdir()
    for path in campaign.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    _rewritten(folder, change)
    return str(folder)


def _measured(folder):
    with two_effects_and_a_formula():
        return steps.read_measured(folder, "tiny", [])


@pytest.mark.parametrize("zero", [-3.0, 0.5, 30.0, 43200.0, 1.7e9])
def test_a_clock_that_starts_elsewhere_reads_the_same(campaign, tmp_path, zero):
    """Readings, forces, the sensors' checks and the plan of the libraries, to the bit."""
    moved = _copy(campaign, tmp_path / "moved", _moved(zero))
    here, there = _measured(str(campaign)), _measured(moved)
    xr.testing.assert_identical(there.readings, here.readings)
    xr.testing.assert_identical(there.forces, here.forces)
    assert there.parity.as_json() == here.parity.as_json()
    with two_effects_and_a_formula():
        plans = [plan_diagnosis(folder, "tiny") for folder in (str(campaign), moved)]
    assert [one.library(test, "") for one in plans[:1] for test in one.tests] == [
        one.library(test, "") for one in plans[1:] for test in one.tests
    ]


@pytest.mark.slow
def test_every_step_of_a_diagnosis_is_the_same_by_a_clock_that_starts_elsewhere(campaign, tmp_path):
    found = []
    for name, zero in (("here", 0.0), ("moved", 43200.0)):
        (tmp_path / f"of-{name}").mkdir()
        folder = _copy(campaign, tmp_path / name, _moved(zero))
        with two_effects_and_a_formula():
            found.append(diagnose(tmp_path / f"of-{name}", folder))
    here, moved = found
    xr.testing.assert_identical(moved.decided.misfit, here.decided.misfit)
    assert moved.decided.decision == here.decided.decision
    assert moved.sized == here.sized
    xr.testing.assert_identical(moved.gained.scores, here.gained.scores)
    xr.testing.assert_identical(moved.gained.consequences, here.gained.consequences)
    xr.testing.assert_identical(moved.horizon, here.horizon)
    assert moved.verdict == here.verdict


@pytest.mark.slow
@pytest.mark.parametrize(
    "change",
    [_read_before(1.5), _read_after(0.4), _read_at(2)],
    ids=["1.5 s before the command", "0.4 s after the command", "100 Hz"],
)
def test_the_cause_is_named_wherever_the_command_begins_and_at_another_rate(campaign, tmp_path, change):
    folder = _copy(campaign, tmp_path / "campaign", change)
    with two_effects_and_a_formula():
        found = diagnose(tmp_path, folder)
    assert found.decided.decision.causes == ("table-pitch",)
    assert found.gained.consequences["drift_history"].notnull().any()


def test_readings_before_the_command_are_left_out(campaign, tmp_path):
    """But for the last one, within a step of the command; what is read off is what the test without them tells."""
    before = _measured(_copy(campaign, tmp_path / "before", _read_before(1.5)))
    here = _measured(str(campaign))
    assert abs(before.readings.sizes["time"] - here.readings.sizes["time"]) <= 1
    assert 0.0 <= before.readings["time"][0] <= 0.005
    spread = here.readings["value"].sel(feature="top.displacement.peak+")
    error = before.readings["value"].sel(feature="top.displacement.peak+") - spread
    assert (np.abs(error) < 5e-4).all()


def test_a_test_at_another_rate_has_its_figure(campaign, tmp_path):
    """Tests at 200 and at 100 Hz: each keeps its own times, and no line of a figure is broken by the other's."""
    folder = tmp_path / "mixed"
    _copy(campaign, folder, _moved(0.0))
    path = folder / "two-100.nc"
    test = _read_at(2)(xr.load_dataset(path))
    path.unlink()
    write_dataset(path, test)
    measured = _measured(str(folder))
    for name, rate in (("one-100", 200.0), ("two-100", 100.0)):
        time = reading_of(measured.readings, name)["time"].to_numpy()
        np.testing.assert_allclose(np.diff(time), 1.0 / rate, atol=1e-9)
        own = forces_of(measured.forces, name)["unexplained"].sel(body="block-1")
        assert np.isfinite(own).mean() > 0.9
