"""Third section of a diagnosis: what was added to the model, its size with interval, and what it rests on."""

from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.figures.sizes import plot_sizes
from blockshake.report.diagnosis.wording import estimate_words, place_words, when_words
from blockshake.report.document.blocks import Figure, Heading, Items, Section, Table
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import interval, quantity, with_unit
from blockshake.report.document.wording import MISSING, sentence_case

_WHERE = {
    "input": "on the table's motion",
    "contact": "in the contacts",
    "geometry": "in the blocks' geometry and mass",
    "force": "as a force on a block",
    "observation": "in the sensors alone",
}


def size_section(found):
    """Equation, place, size and range of every cause that is not excluded; None where nothing acts."""
    causes = [one for part in found.decision.parts for one in part.causes]
    if not causes:
        return None
    blocks = []
    for cause in causes:
        blocks += [Heading(cause.title.capitalize(), f"size-{cause.name}"), Items(_described(cause)), _table(cause)]
        if not cause.outside:
            blocks.append(
                Figure(
                    f"Size of {cause.title}: the range that was tried (grey), the nominal model without it (dashed), "
                    "the interval of 90 % (blue), and the members by which the model is extended (ticks).",
                    svg_of(plot_sizes, cause, EFFECTS[cause.name].parameters),
                )
            )
    return Section("Size of what acts", "size", tuple(blocks))


def _described(cause):
    place = place_words(cause.place)
    if cause.outside:
        acts = ", ".join(words for words in (place, when_words(cause.when)) if words)
        return (
            f"{sentence_case(FORMS[cause.name].title)} Acts {acts}. It is a form that the forces have, and no effect of "
            "the registry.",
        )
    effect = EFFECTS[cause.name]
    return (
        f"Equation: {effect.equation}.",
        f"Acts {_WHERE[effect.acts]}{f', at {place}' if place else ''}.",
        f"Source: {effect.source}.",
        f"Told apart from what looks alike by: {effect.told_apart_by}.",
    )


def _table(cause):
    known = {} if cause.outside else {one.name: one for one in EFFECTS[cause.name].parameters}
    rows = []
    for name, estimate in cause.parameters.items():
        one = known.get(name)
        if one:
            tried = with_unit(interval(one.lower, one.upper, one.unit), one.unit)
            rows.append((name, one.meaning, estimate_words(estimate), tried, quantity(one.null, one.unit)))
        else:
            rows.append((name, "of what acts from outside", estimate_words(estimate), MISSING, quantity(0.0, estimate.unit)))
    return Table(
        f"Size of {cause.title} with its interval of 90 % from all instants of all tests, the range of the registry, and "
        "the value of the nominal model.",
        ("Parameter", "Meaning", "Size", "Range", "Nominal"),
        tuple(rows),
        "lllrr",
    )
