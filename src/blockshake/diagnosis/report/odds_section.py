"""Second section of a diagnosis: the odds of every cause that was tried, and how they were counted."""

from blockshake.diagnosis.answer.answer import FREE_SHARE
from blockshake.diagnosis.answer.odds import COARSENING, ODDS, coarsened
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.report.figures.odds import plot_odds
from blockshake.diagnosis.report.statement import RATIO
from blockshake.diagnosis.wording import name_of
from blockshake.pages.blocks import Figure, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import number, sentence_case


def odds_section(found):
    """Odds and gains of all rivals, one figure a part of the readings."""
    parts = found.decision.parts
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
    for part in parts:
        first = part.causes[0]
        names = sorted(part.odds, key=part.odds.get)
        nothing = coarsened(first.gain, first.gain)
        rows = [(name_of(name), part.odds[name], part.gains[name]) for name in names]
        blocks.append(
            Figure(
                f"{sentence_case(part.readings)[:-1]}: how many times less likely each cause is than "
                f"{first.title}, the likeliest (left; arrows: beyond the axis), and its gain over nothing (right; "
                f"of the likeliest {number(first.gain)}). Shaded: within {RATIO} times, dashed, so that the tests "
                "do not tell them apart. Blue: effects of the registry; orange, in italics: forms from outside, "
                "which none of them is.",
                svg_of(plot_odds, rows, [name in FORMS for name in names], nothing, ODDS),
            )
        )
    return Section("Odds of all causes", "odds", tuple(blocks))
