"""Third section of a diagnosis: what was added to the model, its size with interval, and what it rests on."""

from blockshake.diagnosis.wording import estimate_words, place_words, range_words, size_words, when_words
from blockshake.effects.registry import EFFECTS
from blockshake.pages.blocks import Items, Section, Table
from blockshake.pages.words import Words

_SIZES = Words(__name__)
_WHERE = {
    "input": "on the table's motion",
    "contact": "in the contacts",
    "geometry": "in the blocks' geometry and mass",
    "force": "as a force on a block",
    "observation": "in the sensors alone",
}


def size_section(diagnosed):
    """Size, range, equation and place of every cause that is not excluded; None where nothing acts."""
    causes = [one for part in diagnosed.decision.parts for one in part.causes]
    if not causes:
        return None
    return Section("Size of what acts", "size", (_table(causes), Items(tuple(map(_described, causes)))))


def _described(cause):
    place = place_words(cause.place)
    if cause.outside:
        return _SIZES.outside(cause.title, [words for words in (place, when_words(cause.when)) if words])
    effect = EFFECTS[cause.name]
    return _SIZES.effect(cause.title, _WHERE[effect.acts], place, effect)


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
    return Table(_SIZES.table(), ("Cause", "Parameter", "Size", "Range", "Without"), tuple(rows), "lllrr")


def meaning_words(parameter):
    """Name and meaning of an `EffectParameter`: ``offset of the mass centre along x``."""
    joint = " " if parameter.meaning.startswith(("of ", "on ")) else ": "
    return f"{parameter.name}{joint}{parameter.meaning}"
