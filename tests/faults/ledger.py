"""Ledger of the fault tests: what was done to the program, and what was lost by it."""

from collections import Counter

DONE, LOST = Counter(), Counter()


def tables():
    """The ledger as lines of text, none where nothing was done."""
    if not DONE:
        return []
    return [*_table("done to the program", DONE), "", *_table("lost", LOST)]


def _table(title, counts):
    return [f"{title:64}times", *(f"{name:64}{count:5}" for name, count in sorted(counts.items()))]
