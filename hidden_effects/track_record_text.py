"""Tables of the track record as text, for the terminal and for docs/hidden-effects.md; no figure is typed."""

from blockshake.diagnosis.verdict.track_record import Answers

BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"
_WORDS = {True: "met", False: "missed", None: ""}


def as_markdown(record):
    """The tables of a record.

    Parameters
    ----------
    record : TrackRecord

    Returns
    -------
    str
    """
    lines = [
        f"{record.date}, sources {record.commit}, {record.machine}, seeds {record.seeds}: {len(record.cases)} cases.",
        "",
        "Effort by structure:",
        "",
        *(f"- {structure}: {effort}" for structure, effort in record.efforts.items()),
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
        words = [row.truth, *([row.size] if row.size else []), *(["not a candidate"] if row.removed else [])]
        counts = [str(count) if count else "" for count in row.answers.model_dump().values()]
        lines.append(f"| {', '.join(words)} | {' | '.join(counts)} |")
    return "\n".join(lines)


def with_tables(page, record):
    """A page with the tables of the track record between its two marks."""
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{as_markdown(record)}\n\n{END}{after}"


def tables_of(page):
    """Tables between the marks of a page."""
    return page.split(BEGIN)[1].split(END)[0].strip()


def _goal(figure):
    return "" if figure.goal is None else f"{figure.side} {figure.goal:g}"
