"""Damaged files of a finished study: healed by the same command, or named in one line."""

import re

import pytest
import xarray as xr
from ledger import DONE

from blockshake.store import kept

pytestmark = [pytest.mark.faults, pytest.mark.short_faults]


def _cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def _exchange(path):
    """Another file in its place."""
    path.write_bytes((path.parents[2] / "data" / "peers" / "lmgc90.nc").read_bytes())


DAMAGES = (_cut, _flip, _exchange)


@pytest.fixture
def finished(whole, tmp_path):
    return whole("study").checkout.copied(tmp_path / "damaged")


def test_damaged_units_are_made_anew_and_the_others_are_not(finished):
    results = finished.folder / "results"
    units = sorted((results / "store").glob("[!.]*.nc"))
    batches = sorted((results / "small" / "runs").rglob("*.nc"))
    before = {path: xr.load_dataset(path) for path in batches}
    for damage, unit in zip(DAMAGES, units, strict=False):
        damage(unit)
        DONE["study: finished unit cut, altered or exchanged"] += 1
    names = [str(path.relative_to(finished.folder)) for path in batches]
    answer = finished.snakemake("configuration-1", *names, "-R", "simulate_batch")
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert answer.stdout.count(", simulated:") == len(DAMAGES)
    assert answer.stdout.count(", kept:") == len(units) - len(DAMAGES)
    assert all(kept(unit) for unit in units)
    for path, dataset in before.items():
        xr.testing.assert_identical(xr.load_dataset(path), dataset)


def test_a_damaged_result_is_named_and_made_anew_when_deleted(finished):
    path = finished.folder / "results" / "small" / "runs" / "nscd-rigid" / "configuration-1" / "000-004.nc"
    before = xr.load_dataset(path)
    _cut(path)
    DONE["study: finished result cut"] += 1
    answer = finished.snakemake("configuration-1")
    assert answer.returncode == 2
    name = re.escape(str(path.relative_to(finished.folder)))
    assert re.search(
        rf"^blockshake: {name}: expected the netCDF file", answer.stdout + answer.stderr, re.MULTILINE
    )
    path.unlink()
    answer = finished.snakemake("configuration-1")
    assert answer.returncode == 0, answer.stdout + answer.stderr
    xr.testing.assert_identical(xr.load_dataset(path), before)
