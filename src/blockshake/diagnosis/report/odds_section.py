"""Second section of a diagnosis: the odds of every cause that was tried, and how they were counted."""

from blockshake.diagnosis.answer.answer import COARSENING, coarsened
from blockshake.diagnosis.answer.thresholds import FREE_SHARE
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.report.statement import RATIO
from blockshake.diagnosis.wording import name_of, times_words
from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.wording import number, sentence_case


def odds_section(diagnosed):
    """Odds and gains of all rivals, one table a part of the readings."""
    parts = diagnosed.decision.parts
    blocks = [
        Text(
            "Every cause states the forces that it would make under the measured motion. One likelihood of all "
            "instants, joints and tests compares the causes with each other and with nothing. Gain [nats]: "
            "natural logarithm of how many times likelier the readings are with a cause than without, averaged "
            "over its sizes and places. Odds differ less than gains, because the form of a cause may leave "
            f"{100.0 * COARSENING:.0f} % of what it explains (coarsened posterior, Miller and Dunson 2019). A "
            f"force of no known form stands for all that nobody thought of, and counts with {FREE_SHARE:g} of its "
            "gain."
        )
    ]
    if not parts:
        blocks.append(
            Text(
                "No cause gains more over none than clean campaigns do by chance; there are no odds to show."
            )
        )
    return Section("Odds of all causes", "odds", (*blocks, *map(_table, parts)))


def _table(part):
    """Every cause and none, the likeliest first."""
    first, rows = part.causes[0], []
    odds = {**part.odds, None: coarsened(first.gain, first.gain)}
    for name in sorted(odds, key=odds.get):
        kind = "" if name is None else "form from outside" if name in FORMS else "effect"
        less = times_words(odds[name]) if odds[name] > 0.0 else "the likeliest"
        gain = number(part.gains[name]) if name else "0"
        rows.append((name_of(name) if name else "nothing", kind, less, gain))
    return Table(
        f"{sentence_case(part.readings)[:-1]}: how many times less likely each cause is than {first.title}, and its "
        f"gain over nothing [nats]. Within {RATIO} times the tests do not tell causes apart. A form from outside is "
        "none of the effects of the registry.",
        ("Cause", "Kind", "Less likely", "Gain"),
        tuple(rows),
        "llrr",
    )
