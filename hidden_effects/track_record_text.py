"""Tables of the track record as text, for the terminal and for docs/results/hidden-effects.md; no figure is typed."""

from outside_forces import OUTSIDE
from scored_record import Answers

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
        *_by_structure(record),
        "",
        "| figure | share | of | 95 % interval | goal | |",
        "|---|---|---|---|---|---|",
    ]
    for share in record.shares.values():
        estimate = f"{share.hits / share.n:.3f}" if share.n else "none"
        lines.append(
            f"| {share.meaning} | {estimate} | {share.n} | {share.lower:.3f} to {share.upper:.3f} | "
            f"{_goal(share)} | {_WORDS[share.met]} |"
        )
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
    return "\n".join(lines)


def _by_structure(record):
    """Lines of a table: right answers by structure."""
    yield "| structure | effort | none where nothing is hidden | truth named or in the set | outside called unknown |"
    yield "|---|---|---|---|---|"
    for structure, effort in record.efforts.items():
        own = [case for case in record.cases if case.structure == structure]
        counts = (
            _count(own, ("none",), lambda truth: truth == "none"),
            _count(own, ("right", "set_with"), lambda truth: truth in EFFECTS),
            _count(own, ("unknown",), lambda truth: truth in OUTSIDE),
        )
        yield f"| {structure} | {effort} | {' | '.join(counts)} |"


def _count(cases, answers, belongs):
    own = [case for case in cases if belongs(case.truth)]
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
