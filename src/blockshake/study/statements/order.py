"""Orders of a quantity over the structures, told from chance by the limits of each."""

from typing import NamedTuple

import numpy as np

from blockshake.study.statements.statement import PaperFinding, PaperVerdict, judged, unjudged


class Limited(NamedTuple):
    """A quantity with its limits of 95 %."""

    value: float
    lower: float
    upper: float


def ordered(content, found, pairs, words, written, ceiling=np.inf):
    """Finding that of each pair of cases the second has the larger quantity.

    Met where it is so beyond the limits in every pair, not met where it is smaller beyond them in any. A first case
    whose quantity is at its ceiling has no larger one: its pairs say nothing.

    Parameters
    ----------
    content : Content
    found : dict of str to Limited
        By case; cases of too few samples are not there.
    pairs : list of tuple of str
    words : str
        The quantity.
    written : callable
        Writes a value.
    ceiling : float
        Largest value that the quantity can have.
    """
    lacking = sorted({name for pair in pairs for name in pair} - set(found))
    pairs = [pair for pair in pairs if not set(pair) & set(lacking)]
    names = list(dict.fromkeys(name for pair in pairs for name in pair))
    absent = f" Not in this study, or of too few samples: {', '.join(lacking)}." if lacking else ""
    if not pairs:
        return unjudged(f"This study lacks the cases to compare.{absent}")
    if len({_shaking(content.cases[name]) for name in names}) > 1:
        return unjudged("The cases are shaken differently, which the structures cannot be told from.")
    full = sorted({less for less, _ in pairs if found[less].value >= ceiling})
    pairs = [pair for pair in pairs if pair[0] not in full]
    larger = sum(found[more].lower > found[less].upper for less, more in pairs)
    smaller = sum(found[more].upper < found[less].lower for less, more in pairs)
    told = ", ".join(
        f"{name} {written(found[name].value)} [{written(found[name].lower)}, {written(found[name].upper)}]"
        for name in sorted(names)
    )
    scale = content.cases[names[0]].settings["scale"]
    words = f"{words} at scale {scale:g}, with 95 % limits: {told}. "
    if full:
        words += f"Nothing can be larger than that of {', '.join(full)}. "
    words += (
        f"Pairs of structures in the stated order beyond the limits, all of which met asks for: {larger} of "
        f"{len(pairs)}; in the opposite one, of which one is enough for not met: {smaller}.{absent}"
        if pairs
        else f"No pair of structures is left.{absent}"
    )
    if smaller:
        return judged(False, words)
    return judged(True, words) if larger == len(pairs) and not (lacking or full) else unjudged(words)


def all_of(findings):
    """Finding that each of several findings, by model, is met: the worst verdict is that of all.

    Parameters
    ----------
    findings : dict of str to Finding
        By the name that stands before the words of each; not empty.
    """
    words = " ".join(
        [*(f"{name}: {one.words}" for name, one in findings.items()), "The worst of the models counts."]
    )
    verdicts = {one.verdict for one in findings.values()}
    worst = next(
        one for one in (PaperVerdict.NOT_MET, PaperVerdict.UNJUDGED, PaperVerdict.MET) if one in verdicts
    )
    return PaperFinding(worst, words)


def _shaking(case):
    """Whatever tells the shaking of two cases apart: motion, scale, window."""
    return case.motion, case.settings["scale"], case.settings["duration"]
