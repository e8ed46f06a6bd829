"""Ledger of the fault tests: what was done to the program, what was lost by it, and how long all of it took."""

import os
from collections import Counter

from blockshake.files import PACKAGE, write_json

DONE, LOST = Counter(), Counter()
RECORD = (
    PACKAGE.parents[1] / "results" / "faults.json"
)  # a page of docs shows it, see bench/figures_of_docs.py


def tables():
    """The ledger as lines of text, none where nothing was done."""
    if not DONE:
        return []
    return [*_table("done to the program", DONE), "", *_table("lost", LOST)]


def record(outcomes, minutes):
    """Write the ledger to `RECORD`, with the number of tests by outcome, and the minutes and CPU minutes of all."""
    spent = os.times()
    cpu = (spent.user + spent.system + spent.children_user + spent.children_system) / 60.0
    done, lost = (dict(sorted(counts.items())) for counts in (DONE, LOST))
    RECORD.parent.mkdir(exist_ok=True)
    write_json(
        RECORD, {"done": done, "lost": lost, "outcomes": outcomes, "minutes": minutes, "cpu_minutes": cpu}
    )


def _table(title, counts):
    return [f"{title:84}times", *(f"{name:84}{count:5}" for name, count in sorted(counts.items()))]
