"""Runs that are cut short at a saving of their checkpoint, and whether two runs are the same to the bit."""

from both_solvers import assert_same_bytes

from blockshake.solvers import pieces
from blockshake.solvers.checkpoint import Checkpoint


class CutShortError(Exception):
    pass


def cut_after(monkeypatch, n_savings, steps):
    """Save at every pause, ``steps`` apart, and fall over after so many savings."""
    saved, original = [], Checkpoint.save

    def save(checkpoint, parts):
        original(checkpoint, parts)
        saved.append(checkpoint)
        if len(saved) == n_savings:
            raise CutShortError

    monkeypatch.setattr(pieces, "_SAVING", 0.0)
    monkeypatch.setattr(pieces, "_FIRST_PIECE", steps)
    monkeypatch.setattr(pieces, "_next_piece", lambda steps, spent: steps)
    monkeypatch.setattr(Checkpoint, "save", save)


def assert_same(run, other):
    assert_same_bytes(run, other)
    for field in ("status", "reason", "end_time", "numerics"):
        assert getattr(run, field) == getattr(other, field), field
