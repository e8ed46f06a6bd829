"""Seventh page of a diagnosis: how often the procedure was right where the truth was known."""

from blockshake.diagnosis.verdict.track_record import Answers, procedure_digest
from blockshake.report.document.blocks import Section, Table, Text
from blockshake.report.document.wording import MISSING, number, percent

_MET = {True: "met", False: "missed", None: ""}
_ANSWERS = {
    "none": "No effect",
    "right": "Right name",
    "wrong": "Wrong name",
    "set_with": "Set with it",
    "set_without": "Set without it",
    "unknown": "Unknown",
    "combination": "Several",
}


def track_record_section(found):
    """Shares, medians and confusion matrix of the tests that hide an effect."""
    record = found.track_record
    if record is None:
        text = (
            "This procedure has no track record yet: it has not been run on campaigns in which an effect was hidden, "
            "so that nobody knows how often its answers are right. Read the verdict accordingly."
        )
        return Section("Track record of the procedure", "track-record", (Text(text, strong=True),))
    blocks = [
        Text(
            f"The record holds {record.counted}, in which the truth was known to the scorer alone: those that were "
            "diagnosed twice were so the second time with their effect taken out of the candidates. The campaigns were "
            "made with other numerics and other forms of the effects than the diagnosis has (docs/hidden-effects.md). "
            f"The procedure was run on {record.date} with effort {record.effort}, sources "
            f"{record.commit}, seeds {record.seeds}, on {record.machine}. The figures hold for such campaigns; on "
            "another structure they are an indication."
        )
    ]
    if record.procedure != procedure_digest():
        blocks.append(
            Text(
                "The program that simulates libraries and decides has been changed since: the track record is that of "
                "an earlier one.",
                strong=True,
            )
        )
    if found.effort not in record.efforts.values():
        blocks.append(
            Text(
                f"The track record holds no diagnosis of the effort {found.effort}, with which this one was made.",
                strong=True,
            )
        )
    missed = [one.meaning for one in [*record.shares.values(), *record.medians.values()] if one.met is False]
    if missed:
        blocks.append(Text(f"Figures that missed the goal set beforehand: {'; '.join(missed)}.", strong=True))
    blocks += [_shares(record), _confusion(record)]
    return Section("Track record of the procedure", "track-record", tuple(blocks))


def _shares(record):
    rows = []
    for one in record.shares.values():
        estimate = MISSING if one.estimate is None else f"{percent(one.estimate)} %"
        ends = f"{percent(one.lower)} to {percent(one.upper)} %"
        goal = "" if one.goal is None else f"{one.side} {number(100.0 * one.goal)} %"
        rows.append((one.meaning, estimate, f"{one.hits} of {one.n}", ends, goal, _MET[one.met]))
    for one in record.medians.values():
        estimate = MISSING if one.estimate is None else number(one.estimate)
        ends = "too few" if one.lower is None else f"{number(one.lower)} to {number(one.upper)}"
        goal = "" if one.goal is None else f"{one.side} {number(one.goal)}"
        rows.append((one.meaning, estimate, f"median of {one.n}", ends, goal, _MET[one.met]))
    return Table(
        "What was counted, with intervals of 95 % and the goals set beforehand.",
        ("Figure", "Found", "Cases", "Interval", "Goal", ""),
        tuple(rows),
        "lrrrll",
    )


def _confusion(record):
    rows = []
    for row in record.confusion:
        words = [
            row.truth,
            *([row.size] if row.size else []),
            *(["not among the candidates"] if row.removed else []),
        ]
        counts = row.answers.model_dump()
        rows.append((", ".join(words), *(str(counts[name] or "") for name in Answers.model_fields)))
    return Table(
        "Answers by what was hidden, numbers of diagnoses. It: the truth; unknown: something acts that no known effect "
        "explains.",
        ("Hidden", *(_ANSWERS[name] for name in Answers.model_fields)),
        tuple(rows),
        "l" + "r" * len(_ANSWERS),
    )
