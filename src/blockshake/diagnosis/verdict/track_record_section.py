"""Eighth section of a diagnosis: how often the procedure was right where the truth was known."""

from blockshake.diagnosis.verdict.track_record import WHOLE, procedure_digest
from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.wording import percent

_MET = {True: "met", False: "missed"}
_LABORATORIES = {"home": "own solvers", "mujoco": "MuJoCo", "unusual": "own solvers, unusual settings"}


def track_record_section(diagnosed):
    """Shares of the campaigns in which an effect was hidden."""
    record = diagnosed.track_record
    if record is None:
        text = (
            "This procedure has no track record yet: it has not been run on campaigns in which an effect was hidden, "
            "so that nobody knows how often its answers are right. Read the answer accordingly."
        )
        return Section("Track record of the procedure", "track-record", (Text(text, strong=True),))
    blocks = [
        Text(
            f"Campaigns whose truth only the scorer knew, {record.date}, sources {record.commit}; each figure in the "
            "laboratory in which it is worst. On another structure the figures are an indication. All of them: "
            "docs/results/hidden-effects.md."
        )
    ]
    if record.part != WHOLE:
        blocks.append(Text(f"A part of the list was judged: {record.part} of its cases."))
    if record.procedure != procedure_digest():
        words = "The program that decides has been changed since: the track record is that of an earlier one."
        blocks.append(Text(words, strong=True))
    return Section("Track record of the procedure", "track-record", (*blocks, _shares(record)))


def _shares(record):
    rows = []
    for laboratory, one in record.worst.values():
        rows.append((
            one.meaning, _LABORATORIES.get(laboratory, laboratory), f"{percent(one.estimate)} %",
            f"{one.hits} of {one.n}", f"{percent(one.lower)} to {percent(one.upper)} %",
            f"{one.side} {percent(one.goal)} %", _MET.get(one.met, ""),
        ))  # fmt: skip
    return Table(
        "Shares of the cases with intervals of 95 %, and the goals set beforehand.",
        ("Figure", "Laboratory", "Found", "Cases", "Interval", "Goal", ""),
        tuple(rows),
        "llrrrrl",
    )
