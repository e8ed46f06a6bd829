"""A campaign on its way from files to seen tests: every file is read once, copies and sealed tests never count."""

import shutil

import numpy as np
import pytest
import xarray as xr
import yaml
from tiny_campaign import write_campaign

from blockshake.diagnosis import steps
from blockshake.diagnosis.evidence.reconstructed_campaign import reconstruct_campaign, reconstruct_sealed
from blockshake.errors import InputError
from blockshake.files import PACKAGE, write_dataset
from blockshake.measurement.campaigns import campaign as campaign_module
from blockshake.measurement.campaigns.campaign import load_campaign

STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"
OPEN = ["one-100", "two-100"]


@pytest.fixture
def folder(tmp_path):
    write_campaign(tmp_path, STRUCTURE)
    return tmp_path


def _with_test(folder, name, like):
    path = folder / "campaign.yaml"
    file = yaml.safe_load(path.read_text())
    entry = next(test for test in file["tests"] if test["name"] == like)
    file["tests"].append(entry | {"name": name, "file": f"{name}.nc"})
    path.write_text(yaml.safe_dump(file))


def test_every_open_file_is_read_once_and_the_sealed_one_never(folder, monkeypatch):
    read = []
    original = campaign_module.read_test
    monkeypatch.setattr(
        campaign_module,
        "read_test",
        lambda path, structure: read.append(path.name) or original(path, structure),
    )
    found = reconstruct_campaign(load_campaign(folder))
    assert read == ["one-100.nc", "two-100.nc"]
    assert [test.name for test in found.tests] == OPEN
    assert (found.parity.findings, found.parity.falls, found.unseen) == ((), {}, {})
    assert all(np.isfinite(test.forces.force).any() for test in found.tests)


def test_a_copy_of_a_test_is_no_new_evidence(folder):
    shutil.copy(folder / "one-100.nc", folder / "again.nc")
    _with_test(folder, "again", "one-100")
    found = reconstruct_campaign(load_campaign(folder))
    assert [test.name for test in found.tests] == OPEN
    assert list(found.parity.gaps) == OPEN


def test_a_sealed_test_is_not_opened(folder):
    (folder / "one-150.nc").write_text("not a netCDF file: opening it would be another error")
    campaign = load_campaign(folder)
    reconstruct_campaign(campaign)
    with pytest.raises(InputError, match="one-150"):
        reconstruct_sealed(campaign)


def test_a_fault_is_taken_out_before_a_test_is_seen(folder):
    for name in OPEN:
        path = folder / f"{name}.nc"
        test = xr.load_dataset(path)
        own = test["marker"] == "block-2-upper"
        write_dataset(
            path, test.assign(marker_displacement=test["marker_displacement"] * xr.where(own, 1.1, 1.0))
        )
    campaign = load_campaign(folder)
    found, kept = reconstruct_campaign(campaign), reconstruct_campaign(campaign, ["sensor-gain"])
    assert [(finding.effect, finding.where) for finding in found.parity.findings] == [
        ("sensor-gain", ("block-2-upper",))
    ]
    assert kept.parity.findings == ()
    factor = kept.tests[0].readings["marker_displacement"] / found.tests[0].readings["marker_displacement"]
    assert float(factor.sel(marker="block-2-upper", axis="x").median()) == pytest.approx(1.1, abs=2e-3)


def test_a_test_too_short_for_the_kernel_is_said(folder):
    write_dataset(folder / "one-100.nc", xr.load_dataset(folder / "one-100.nc").isel(time=slice(40)))
    found = reconstruct_campaign(load_campaign(folder))
    assert found.unseen == {"one-100": "the test is too short"}
    assert [test.name for test in found.tests] == ["two-100"]


def test_a_campaign_of_which_no_test_is_seen_ends_without_a_cause_and_with_the_reasons(folder):
    for name in OPEN:
        write_dataset(folder / f"{name}.nc", xr.load_dataset(folder / f"{name}.nc").isel(time=slice(40)))
    decided = steps.decide(str(folder), (), None).decision
    assert (decided.decision, decided.tests) == ("none", ())
    assert decided.cannot_see == tuple(f"{name} is not judged: the test is too short" for name in OPEN)


def test_sensors_without_stated_noise_are_the_best_instruments(folder):
    campaign = load_campaign(folder)
    silent = {"marker_noise": 0.0, "accelerometer_noise": 0.0}
    path = folder / "campaign.yaml"
    path.write_text(yaml.safe_dump(yaml.safe_load(path.read_text()) | {"sensors": silent}))
    found = reconstruct_campaign(load_campaign(folder))
    assert all(np.isfinite(part).all() for test in found.tests for part in test.rows.noise.values())
    assert [test.name for test in found.tests] == [test.name for test in reconstruct_campaign(campaign).tests]
