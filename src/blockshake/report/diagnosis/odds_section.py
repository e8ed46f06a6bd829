"""Second section of a diagnosis: the odds of every cause that was tried, and how they were counted."""

from blockshake.diagnosis.answer.answer import COARSENING, FREE_SHARE, ODDS, coarsened
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.report.diagnosis.figures.odds import plot_odds
from blockshake.report.diagnosis.wording import name_of
from blockshake.report.document.blocks import Figure, Section, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import number, sentence_case

_RATIO = 20  # of the odds within which causes are not told apart


def odds_section(found):
    """Odds and gains of all rivals, one figure a part of the readings."""
    parts = found.decision.parts
    blocks = [
        Text(
            "Every cause states the forces that it would make under the measured motion; one likelihood of all instants, "
            "joints and tests compares the causes, forms from outside among them, with nothing. Gain: the natural "
            "logarithm of how much likelier the readings are with a cause than without, averaged over its sizes "
            f"and places. Odds: a form may leave {100.0 * COARSENING:.0f} % of what it explains (Miller and Dunson "
            "2019, coarsened posteriors), so that they differ less than the gains. A force of no known form counts with "
            f"{FREE_SHARE:g} of its gain."
        )
    ]
    if not parts:
        blocks.append(Text("No cause gains more over none than clean campaigns do by chance; there are no odds to show."))
    for part in parts:
        first = part.causes[0]
        names = sorted(part.odds, key=part.odds.get)
        nothing = coarsened(first.gain, first.gain)
        rows = [(_label(name), part.odds[name], part.gains[name]) for name in names]
        blocks.append(
            Figure(
                f"{sentence_case(part.readings)[:-1]}: odds against each cause, and its gain over none. Shaded: within 1 to "
                f"{_RATIO} of the likeliest, which the tests do not tell apart. Forms from outside, which no effect of "
                f"the registry is, are in italics. The likeliest gains {number(first.gain)}.",
                svg_of(plot_odds, rows, [name in FORMS for name in names], nothing, ODDS),
            )
        )
    return Section("Odds of all causes", "odds", tuple(blocks))


def _label(name):
    return name_of(name).partition(" from an instant")[0]
