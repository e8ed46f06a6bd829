"""The two works that faults are done to: a small study, and a quick diagnosis of a small campaign."""

import os
import subprocess
import time

import psutil
import pytest
import xarray as xr
import yaml
from checkout import Checkout, heed_interrupts

from blockshake.files import load_yaml

# arguments of Snakemake by work
WORKS = {
    "study": ("all",),
    "diagnosis": ("diagnose", "--config", "campaign=small-campaign", "effort=quick"),
}
# the shorter tests are those of the study: `make test-faults-few`
BOTH = (pytest.param("study", marks=pytest.mark.short_faults), "diagnosis")
GRACE = 10.0  # s; in which jobs end with their command, on a machine that may be busy
_SHIPPED = "data/virtual-campaign/configuration-1"
_OPEN = ("alkion-200", "basso-tirreno-200")
_LENGTH = 4.0  # s; of each test: by then the stack rocks, and the diagnosis takes two fifths of the time


def checkout_with_campaign(folder):
    """A checkout with a small study and, in ``small-campaign``, the first seconds of two shipped tests."""
    checkout = Checkout(folder)
    campaign = load_yaml(folder / _SHIPPED / "campaign.yaml")
    campaign["tests"] = [test for test in campaign["tests"] if test["name"] in _OPEN]
    small = folder / "small-campaign"
    small.mkdir()
    (small / "campaign.yaml").write_text(yaml.safe_dump(campaign, sort_keys=False))
    for test in campaign["tests"]:
        readings = xr.load_dataset(folder / _SHIPPED / test["file"])
        readings.sel(time=slice(0.0, _LENGTH), time_acc=slice(0.0, _LENGTH)).to_netcdf(small / test["file"])
    return checkout


def start(checkout, work, *options):
    """Start a work in a process group of its own."""
    return subprocess.Popen(
        checkout.command(*WORKS[work], *options), cwd=checkout.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, start_new_session=True, preexec_fn=heed_interrupts,
    )  # fmt: skip


def count_orphans(folder):
    """Processes that work in a folder though no command does; they are ended."""
    deadline = time.monotonic() + GRACE
    while (left := [one for one in psutil.process_iter() if _works_in(one, folder)]) and (
        time.monotonic() < deadline
    ):
        time.sleep(0.1)
    for one in left:
        one.kill()
    return len(left)


def _works_in(process, folder):
    try:
        return process.cwd() == os.fspath(folder)
    except psutil.Error:
        return False
