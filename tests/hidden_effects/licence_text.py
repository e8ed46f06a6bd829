"""The licence's tables as text, for the terminal and for docs/hidden-effects.md: nothing in them is typed."""

from blockshake.diagnosis.licence import Answers

BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"
_WORDS = {True: "met", False: "missed", None: ""}


def as_markdown(licence):
    """The tables of a licence.

    Parameters
    ----------
    licence : Licence

    Returns
    -------
    str
    """
    lines = [
        f"{licence.date}, sources {licence.commit}, {licence.machine}, effort {licence.effort}, seeds {licence.seeds}: "
        f"{len(licence.cases)} cases.",
        "",
        "| figure | share | of | 95 % interval | goal | |",
        "|---|---|---|---|---|---|",
    ]
    for share in licence.shares.values():
        estimate = f"{share.hits / share.n:.3f}" if share.n else "none"
        lines.append(
            f"| {share.meaning} | {estimate} | {share.n} | {share.lower:.3f} to {share.upper:.3f} | "
            f"{_goal(share)} | {_WORDS[share.met]} |"
        )
    lines += ["", "| figure | median | of | 95 % interval | goal | |", "|---|---|---|---|---|---|"]
    for median in licence.medians.values():
        estimate = "none" if median.estimate is None else f"{median.estimate:.2f}"
        interval = "too few" if median.lower is None else f"{median.lower:.2f} to {median.upper:.2f}"
        lines.append(
            f"| {median.meaning} | {estimate} | {median.n} | {interval} | {_goal(median)} | {_WORDS[median.met]} |"
        )
    heads = [name.replace("_", " ") for name in Answers.model_fields]
    lines += ["", f"| truth | {' | '.join(heads)} |", "|---|" + "---|" * len(heads)]
    for row in licence.confusion:
        words = [row.truth, *([row.size] if row.size else []), *(["not a candidate"] if row.removed else [])]
        counts = [str(count) if count else "" for count in row.answers.model_dump().values()]
        lines.append(f"| {', '.join(words)} | {' | '.join(counts)} |")
    return "\n".join(lines)


def with_tables(page, licence):
    """A page with the licence's tables between its two marks."""
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{as_markdown(licence)}\n\n{END}{after}"


def tables_of(page):
    """What stands between the marks of a page."""
    return page.split(BEGIN)[1].split(END)[0].strip()


def _goal(figure):
    return "" if figure.goal is None else f"{figure.side} {figure.goal:g}"
