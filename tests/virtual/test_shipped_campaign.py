"""The campaign in data/: synthetic, complete, small, and read like any other."""

import pytest
import xarray as xr

from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.checks.campaign_check import campaign_lines

DATA = PACKAGE.parents[1] / "data" / "virtual-campaign"
MOST_BYTES = 20e6


@pytest.mark.parametrize("number", [1, 2, *(pytest.param(wall, marks=pytest.mark.slow) for wall in (3, 4))])
def test_it_passes_through_the_reader(number):
    folder = DATA / f"configuration-{number}"
    campaign = load_campaign(folder)
    assert campaign.structure == f"configuration-{number}"
    assert {test.motion for test in campaign.tests.values()} == {"alkion", "basso-tirreno"}
    assert {test.role for test in campaign.tests.values()} == {"fit", "select", "sealed"}
    lines = campaign_lines(folder)
    assert not [line for line in lines if "remarks" in line], lines
    for test in campaign.tests.values():
        with xr.open_dataset(folder / test.file) as file:
            assert file.attrs["synthetic"] == 1
            assert "synthetic" in file.attrs["title"]


def test_it_says_synthetic_and_is_small():
    assert (DATA / "SOURCE.md").read_text().startswith("# Synthetic")
    assert sum(path.stat().st_size for path in DATA.rglob("*")) < MOST_BYTES
