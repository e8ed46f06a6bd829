"""Seventh section of a diagnosis: sizes that would have been seen, and what the tests do not show."""

from blockshake.effects.registry import EFFECTS, title_of
from blockshake.report.diagnosis.wording import beyond, listed, named_place
from blockshake.report.document.blocks import Items, Section, Table, Text
from blockshake.report.document.wording import MISSING, sentence_case


def limits_section(found):
    """Table of detection limits, what the sensors do not show, caveats."""
    decision = found.decision
    caveats = [one for one in dict.fromkeys(found.verdict.caveats) if one not in decision.cannot_see]
    blocks = [
        Text(
            "A cause that is as large as its limit would have been seen beyond chance. The limits follow from "
            "the forces and the noise of these tests, before any cause is looked for."
        ),
        _table(found),
    ]
    if decision.cannot_see:
        blocks += [Text("The sensors do not show:"), Items(tuple(map(sentence_case, decision.cannot_see)))]
    if caveats:
        blocks += [Text("Caveats:"), Items(tuple(map(sentence_case, caveats)))]
    return Section("Limits: what would have been seen", "limits", tuple(blocks))


def _table(found):
    rows = []
    for name, effect in EFFECTS.items():
        if effect.acts == "observation" or name not in found.decision.probabilities:
            continue
        limits, first = found.decision.limits.get(name, {}), effect.parameters[0]
        ranked = sorted(limits, key=lambda place: abs(limits[place] - first.null))
        if not ranked:
            rows.append((title_of(name), f"{first.name} {first.meaning}", "not seen at any place", MISSING, MISSING))
            continue
        ends = [f"{beyond(name, limits[place])}, {named_place(place, found.bodies)}" for place in (ranked[0], ranked[-1])]
        wherever = found.decision.excluded_above.get(name)
        rows.append((
            title_of(name), f"{first.name} {first.meaning}", ends[0], ends[1] if len(ranked) > 1 else "the same",
            beyond(name, wherever) if wherever is not None else "no",
        ))  # fmt: skip
    removed = [title_of(name) for name in EFFECTS if name not in found.decision.probabilities]
    return Table(
        "Sizes from which each effect would have been seen: where it would be seen best, where worst among the places at "
        "which the tests tell it, and wherever it may be."
        + (f" Left out on purpose: {listed(removed)}." if removed else ""),
        ("Effect", "Size", "Seen best from", "Seen worst from", "Seen everywhere from"),
        tuple(rows),
        "lllll",
    )
