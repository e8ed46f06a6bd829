"""Third section of a diagnosis: what was added to the model, its size with interval, and what it rests on."""

from blockshake.diagnosis.wording import (
    estimate_words,
    place_words,
    range_words,
    shown_unit,
    size_words,
    when_words,
)
from blockshake.effects.registry import EFFECTS
from blockshake.pages.blocks import Figure, Items, Section, Table
from blockshake.pages.drawing import BLACK, BLUE, DARK_GREY, LIGHT_GREY, SKY, new_figure, svg_of

_WHERE = {
    "input": "on the table's motion",
    "contact": "in the contacts",
    "geometry": "in the blocks' geometry and mass",
    "force": "as a force on a block",
    "observation": "in the sensors alone",
}
_ROOM = 0.04  # of the range, beyond either end


def size_section(diagnosed):
    """Size, range, equation and place of every cause that is not excluded; None where nothing acts."""
    causes = [one for part in diagnosed.decision.parts for one in part.causes]
    if not causes:
        return None
    blocks = [_table(causes)]
    effects = [one for one in causes if not one.outside]
    if effects:
        blocks.append(
            Figure(
                "Sizes on the ranges of the registry (grey): likeliest (dot) and its interval of 90 % (blue); "
                "without the cause (dashed); the draws by which the model is extended (ticks).",
                svg_of(plot_sizes, effects),
            )
        )
    return Section("Size of what acts", "size", (*blocks, Items(tuple(map(_described, causes)))))


def _described(cause):
    title, place = cause.title[0].upper() + cause.title[1:], place_words(cause.place)
    if cause.outside:
        acts = ", ".join(words for words in (place, when_words(cause.when)) if words)
        return f"{title}: at {acts}. A form that the forces have, and no effect of the registry."
    effect = EFFECTS[cause.name]
    return (
        f"{title}: acts {_WHERE[effect.acts]}{f', at {place}' if place else ''}. Equation: {effect.equation} "
        f"({effect.source}). Told apart from what looks alike by: {effect.told_apart_by}."
    )


def _table(causes):
    rows = []
    for cause in causes:
        known = {} if cause.outside else {one.name: one for one in EFFECTS[cause.name].parameters}
        for number, (name, estimate) in enumerate(cause.parameters.items()):
            one = known.get(name)
            rows.append((
                cause.title, meaning_words(one) if one else name, estimate_words(name, estimate),
                range_words(one.lower, one.upper, one.unit) if one else "",
                "" if number else size_words(one.null if one else 0.0, estimate.unit),
            ))  # fmt: skip
    return Table(
        "Sizes with their intervals of 90 %, from all instants of all tests; the range of the registry, and the "
        "value in a model without the cause.",
        ("Cause", "Parameter", "Size", "Range", "Without"),
        tuple(rows),
        "lllrr",
    )


def meaning_words(parameter):
    """Name and meaning of an `EffectParameter`: ``offset of the mass centre along x``."""
    joint = " " if parameter.meaning.startswith(("of ", "on ")) else ": "
    return f"{parameter.name}{joint}{parameter.meaning}"


def plot_sizes(causes):
    """Figure of the parameters of every `Cause` of the registry, a strip each."""
    strips = [(cause, parameter) for cause in causes for parameter in EFFECTS[cause.name].parameters]
    figure = new_figure(0.003 + 0.0135 * len(strips))
    panels = figure.subplots(len(strips), 1, squeeze=False)[:, 0]
    for axes, (cause, known) in zip(panels, strips, strict=True):
        factor, unit = shown_unit(known.unit)
        estimate = cause.parameters[known.name]
        low, high = min(known.lower, estimate.lower), max(known.upper, estimate.upper)
        axes.axvspan(factor * known.lower, factor * known.upper, color=LIGHT_GREY, linewidth=0.0)
        axes.axvspan(factor * estimate.lower, factor * estimate.upper, color=SKY, alpha=0.6, linewidth=0.0)
        if known.name == next(iter(cause.parameters)):
            axes.axvline(factor * known.null, color=DARK_GREY, linestyle="--", linewidth=0.8)
        members = [factor * member[known.name] for member in cause.members if known.name in member]
        axes.plot(members, [0.25] * len(members), "|", color=BLACK, markersize=6.0, markeredgewidth=0.5)
        axes.plot(factor * estimate.estimate, 0.65, "o", color=BLUE, markersize=5.0)
        axes.set_xlim(factor * (low - _ROOM * (high - low)), factor * (high + _ROOM * (high - low)))
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([])
        axes.grid(False)
        axes.set_xlabel(f"{known.name} [{unit}], {cause.title}")
    return figure
