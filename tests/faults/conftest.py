import functools
import time
from typing import NamedTuple

import ledger
import pytest
from checkout import Checkout
from work import WORKS, checkout_with_campaign

from blockshake.simulation.simulate import compile_kernels

_BEGUN = time.time()


class Whole(NamedTuple):
    """A work that nothing happened to, and how long it took with its kernels compiled [s]."""

    checkout: Checkout
    seconds: float


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """Works that nothing happened to, by name: each is run when it is first requested."""
    for model in ("ls-dem", "nscd-rigid"):
        compile_kernels(model)

    @functools.cache
    def finished(work):
        checkout = checkout_with_campaign(tmp_path_factory.mktemp(f"whole-{work}"))
        began = time.monotonic()
        answer = checkout.snakemake(*WORKS[work])
        assert answer.returncode == 0, answer.stdout + answer.stderr
        return Whole(checkout, time.monotonic() - began)

    return finished


def pytest_terminal_summary(terminalreporter):
    """Print the ledger under the results, and keep it."""
    for line in ledger.tables():
        terminalreporter.write_line(line)
    if ledger.DONE:
        outcomes = {
            name: len(terminalreporter.getreports(name)) for name in ("passed", "failed", "error", "skipped")
        }
        ledger.record(outcomes, (time.time() - _BEGUN) / 60.0)
