"""Ctrl-C ends a study and a diagnosis within seconds, without an orphan or a lock, and the same command goes on."""

import os
import signal
import time

import pytest
from ledger import DONE
from work import BOTH, WORKS, checkout_with_campaign, count_orphans, start

pytestmark = pytest.mark.faults
SECONDS = 15.0  # on a machine that may be busy


@pytest.mark.parametrize("work", BOTH)
def test_an_interrupted_work_ends_and_goes_on(work, tmp_path):
    checkout = checkout_with_campaign(tmp_path)
    command = start(checkout, work)
    store = checkout.folder / "results" / "store"
    while not list(store.rglob("*.nc")):
        assert command.poll() is None
        time.sleep(0.05)
    os.killpg(command.pid, signal.SIGINT)
    asked = time.monotonic()
    said, _ = command.communicate()
    DONE[f"{work}: Ctrl-C"] += 1
    assert time.monotonic() - asked < SECONDS
    assert command.returncode not in (0, None)
    assert count_orphans(checkout.folder) == 0
    assert "the same command goes on" in said
    finished = {path: path.stat().st_mtime_ns for path in store.rglob("[!.]*.nc")}
    answer = checkout.snakemake(*WORKS[work])
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert {path: path.stat().st_mtime_ns for path in finished} == finished
