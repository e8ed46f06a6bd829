"""The track record as tables and as sentences, for the terminal, its page and the README; no figure is typed."""

import textwrap

from outside_forces import OUTSIDE
from scored_record import Answers

from blockshake.diagnosis.verdict.track_record_section import part_in_words, track_record_lines
from blockshake.effects.registry import EFFECTS

_WORDS = {True: "met", False: "missed", None: ""}


def as_markdown(record):
    """The tables of a record.

    Parameters
    ----------
    record : ScoredRecord

    Returns
    -------
    str
    """
    lines = [
        f"{record.date}, sources {record.commit}, {record.machine}, seeds {record.seeds}: {record.counted}.",
        "",
        *_by_laboratory(record),
        "",
        *_by_structure(record),
        "",
        *_intervals(record),
    ]
    lines += ["", "| figure | median | of | 95 % interval | goal | |", "|---|---|---|---|---|---|"]
    for median in record.medians.values():
        estimate = "none" if median.estimate is None else f"{median.estimate:.2f}"
        interval = "too few" if median.lower is None else f"{median.lower:.2f} to {median.upper:.2f}"
        lines.append(
            f"| {median.meaning} | {estimate} | {median.n} | {interval} | {_goal(median)} | {_WORDS[median.met]} |"
        )
    heads = [name.replace("_", " ") for name in Answers.model_fields]
    lines += ["", f"| truth | {' | '.join(heads)} |", "|---|" + "---|" * len(heads)]
    for row in record.confusion:
        words = [row.truth, *([row.size] if row.size else [])]
        counts = [str(count) if count else "" for count in row.answers.model_dump().values()]
        lines.append(f"| {', '.join(words)} | {' | '.join(counts)} |")
    if record.gains:
        lines += ["", *_gains(record)]
    return "\n".join(lines)


def in_words(record):
    """The record in sentences of a page, in lines of 100 columns."""
    part = part_in_words(record)
    sentences = [
        f"The diagnosis was tried on {len(record.cases)} synthetic campaigns with a sealed truth"
        f"{f', {part} of those planned' if part else ''}.",
        *track_record_lines(record),
        "The [track record](docs/results/hidden-effects.md) has every figure and every miss.",
    ]
    return "\n".join(textwrap.wrap(" ".join(sentences), 100, break_long_words=False, break_on_hyphens=False))


def hits(share):
    """A share as its count, such as ``3 of 40``."""
    return f"{share.hits} of {share.n}"


def _by_laboratory(record):
    """Lines of a table: every figure home and abroad, and by laboratory."""
    columns = {**record.laboratories, "abroad": record.abroad} if record.abroad else record.laboratories
    yield f"| figure | {' | '.join(columns)} | goal | worst |"
    yield "|---|" + "---|" * (len(columns) + 2)
    for name, share in record.shares.items():
        cells = [_cell(own[name]) for own in columns.values()]
        laboratory, worst = record.worst.get(name, ("", None))
        met = f"{laboratory}, {_WORDS[worst.met]}" if worst else ""
        yield f"| {share.meaning} | {' | '.join(cells)} | {_goal(share)} | {met} |"


def _cell(share):
    return f"{share.estimate:.3f} ({hits(share)})" if share.n else "none"


def _intervals(record):
    """Lines of a table: intervals of the figures with a goal, home and abroad."""
    first, home = next(iter(record.laboratories.items()))
    yield f"| figure, 95 % interval | {first} | abroad | all |"
    yield "|---|---|---|---|"
    for name, share in record.shares.items():
        if share.goal is not None:
            cells = [
                f"{one.lower:.3f} to {one.upper:.3f}" if one is not None and one.n else "none"
                for one in (home[name], record.abroad.get(name), share)
            ]
            yield f"| {share.meaning} | {' | '.join(cells)} |"


def _gains(record):
    """Lines of a table: gains of single cases over the nominal model."""
    yield "| truth | laboratory | answer | gain on the forces | found | oracle |"
    yield "|---|---|---|---|---|---|"
    for case in sorted(record.gains, key=lambda case: (case.truth, case.laboratory, case.name)):
        found = _gain(case.found) if case.proposed else "not proposed"
        words = ", ".join([case.truth, *([case.size] if case.size else [])])
        rows = "" if case.rows is None else _gain(case.rows)
        oracle = _gain(case.oracle)
        if case.oracle is None or not case.oracle.gains:
            oracle += ", the cause changes no prediction"
        yield f"| {words} | {case.laboratory} | {case.answer} | {rows} | {found} | {oracle} |"


def _gain(contrast):
    if contrast is None:
        return "nothing to gain"
    return f"{contrast.estimate:.2f} ({contrast.lower:.2f} to {contrast.upper:.2f})"


def _by_structure(record):
    """Lines of a table: right answers by structure."""
    yield "| structure | none where nothing is hidden | truth named or in the set | outside called unknown |"
    yield "|---|---|---|---|"
    for structure in dict.fromkeys(case.structure for case in record.cases):
        own = [case for case in record.cases if case.structure == structure]
        counts = (
            _count(own, ("none",), lambda truth: truth == "none"),
            _count(own, ("right", "set_with"), lambda truth: truth in EFFECTS),
            _count(own, ("unknown",), lambda truth: truth in OUTSIDE),
        )
        yield f"| {structure} | {' | '.join(counts)} |"


def _count(cases, answers, belongs):
    own = [case for case in cases if belongs(case.truth) and not case.unseen]
    return f"{sum(case.answer in answers for case in own)} of {len(own)}"


def with_block(page, name, text):
    """A page with a text between the two marks of a block."""
    begin, end = _marks(name)
    before, rest = page.split(begin)
    return f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end)[1]}"


def block_of(page, name):
    """Text between the marks of a page's block."""
    begin, end = _marks(name)
    return page.split(begin)[1].split(end)[0].strip()


def _marks(name):
    return f"<!-- {name}: begin -->", f"<!-- {name}: end -->"


def _goal(figure):
    return "" if figure.goal is None else f"{figure.side} {figure.goal:g}"
