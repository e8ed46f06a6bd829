"""Seventh section of a diagnosis: sizes that would have been seen, and what the tests do not show."""

from blockshake.diagnosis.answer.places import EVERYWHERE
from blockshake.diagnosis.gain.section import OF_GAIN
from blockshake.diagnosis.report.size_section import meaning_words
from blockshake.diagnosis.wording import beyond, named_place
from blockshake.effects.registry import EFFECTS, title_of
from blockshake.pages.blocks import Items, Section, Table, Text
from blockshake.pages.wording import sentence_case
from blockshake.pages.words import Words

_SEEN = Words(__name__)


def limits_section(diagnosed):
    """Table of detection limits, what the sensors do not show, caveats."""
    decision = diagnosed.decision
    elsewhere = (*OF_GAIN, "do not tell these apart", ", by test: ")  # in sections of their own
    caveats = [
        one for one in dict.fromkeys(diagnosed.verdict.caveats)
        if one not in decision.cannot_see and not any(words in one for words in elsewhere)
    ]  # fmt: skip
    blocks = [Text(_SEEN.method()), _table(diagnosed)]
    if decision.cannot_see:
        blocks += [Text(_SEEN.hidden()), Items(tuple(map(sentence_case, decision.cannot_see)))]
    if caveats:
        blocks += [Text(_SEEN.caveats()), Items(tuple(map(sentence_case, caveats)))]
    return Section("Limits: what would have been seen", "limits", tuple(blocks))


def _table(diagnosed):
    rows = []
    for name, effect in EFFECTS.items():
        if effect.acts == "observation" or name not in diagnosed.decision.probabilities:
            continue
        first = effect.parameters[0]
        limits = diagnosed.decision.limits.get(name, {})
        ranked = sorted(limits, key=lambda place: abs(limits[place] - first.null))
        ends = [_seen(diagnosed, name, limits, place) for place in ranked[:: max(len(ranked) - 1, 1)]]
        wherever = diagnosed.decision.excluded_above.get(name)
        rows.append((
            title_of(name), meaning_words(first), *(ends or ["not seen"]), *[""] * (2 - max(len(ends), 1)),
            beyond(name, wherever) if wherever is not None else "not everywhere",
        ))  # fmt: skip
    removed = [title_of(name) for name in EFFECTS if name not in diagnosed.decision.probabilities]
    head = ("Effect", "Size", "At the best place", "At the worst place", "Wherever it is")
    return Table(_SEEN.table(removed), head, tuple(rows), "lllll", (0.2, 0.25, 0.2, 0.2, 0.15))


def _seen(diagnosed, name, limits, place):
    where = named_place(place, diagnosed.bodies)
    words = beyond(name, limits[place])
    if place == EVERYWHERE:
        return words if len(limits) == 1 else f"{words}, everywhere alike"
    return f"{words}, {where}"
