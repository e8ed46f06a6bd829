"""Statements on envelopes: their thickness, residuals, and the variables behind them."""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from blockshake.report.document.wording import (
    given,
    millimetres,
    model_label,
    parameter_label,
    share_words,
)
from blockshake.report.study.sensitivity.summary import markers_by_height, shaking, thickness_by_case
from blockshake.report.study.statements.specimens import HEIGHTS
from blockshake.report.study.statements.statement import (
    Finding,
    Verdict,
    judged,
    missing,
    scale_words,
    unjudged,
)
from blockshake.study.comparison.differences import FEWEST
from blockshake.study.ensembles.intervals import SURE_FROM
from blockshake.study.sensitivity.findings import influences, is_known

_FIRST, _THIRD, _FOURTH = "configuration-1", "configuration-3", "configuration-4"
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}


def upward(content, model):
    """Thickness from block to block."""
    if absent := missing(content, model):
        return unjudged(absent)
    known = {name: one for name, one in thickness_by_case(content, model).items() if one.known}
    if not known:
        return unjudged("Too few samples completed.")
    grows = [name for name, one in known.items() if one.grows_upward]
    told = "; ".join(
        f"{name} {', '.join(millimetres(spread) for spread in one.spread)} mm" for name, one in known.items()
    )
    return judged(
        len(grows) == len(known),
        f"Standard deviation from the lowest block up{scale_words(content)}: {told}. It grows from each block to the "
        f"next in {share_words(len(grows), len(known))} cases.",
    )


def than_first(content, model):
    """Thickness at the top of configurations 2 to 4 against configuration 1."""
    return _tops(content, model, [(_FIRST, name) for name in content.cases if name != _FIRST])


def fourth_than_third(content, model):
    """Thickness at the top of configuration 4 against configuration 3."""
    return _tops(content, model, [(_THIRD, _FOURTH)])


def with_structure(content, models):
    """Thickness at the top with the number of blocks, model by model."""
    own = [model for model in models if model in content.study["models"]]
    if not own:
        return unjudged(missing(content, *models))
    blocks = {name: int((~case.structure.driven).sum()) for name, case in content.cases.items()}
    pairs = [
        (less, more)
        for less, more in combinations(sorted(blocks, key=blocks.get), 2)
        if blocks[less] < blocks[more]
    ]
    found = {model: _tops(content, model, pairs) for model in own}
    verdicts = {one.verdict for one in found.values()}
    words = " ".join(f"{model_label(model)}: {one.words}" for model, one in found.items())
    if absent := missing(content, *models):
        words += f" {absent}"
    for verdict in (Verdict.NOT_MET, Verdict.UNJUDGED):
        if verdict in verdicts:
            return Finding(verdict, words)
    return judged(True, words)


def _tops(content, model, pairs):
    """Finding that of each pair of cases the second has the thicker envelope at its top.

    The thickness is the mean difference of two samples, whose limits tell an order from chance.
    """
    if absent := missing(content, model):
        return unjudged(absent)
    tops = {name: _top_width(case, model) for name, case in content.cases.items() if name in HEIGHTS}
    known = {name: one for name, one in tops.items() if np.isfinite(one).all()}
    pairs = [pair for pair in pairs if set(pair) <= set(known)]
    if not pairs:
        return unjudged(
            "This study lacks one of the cases to compare, or samples of it: it has "
            f"{', '.join(known) or 'none'} with at least {FEWEST} samples."
        )
    compared = dict.fromkeys(name for pair in pairs for name in pair)
    if len({shaking(content.cases[name]) for name in compared}) > 1:
        return unjudged("The cases are shaken differently, which the structures cannot be told from.")
    thicker = sum(known[more].lower > known[less].upper for less, more in pairs)
    thinner = sum(known[more].upper < known[less].lower for less, more in pairs)
    told = ", ".join(
        f"{name} {millimetres(one.width)} [{millimetres(one.lower)}, {millimetres(one.upper)}] mm"
        for name, one in known.items()
        if name in compared
    )
    words = (
        f"Mean difference of two samples at the top{scale_words(content)}, with 95 % limits: {told}. Of {len(pairs)} "
        f"pairs the one that is to be thicker is so beyond the limits in {thicker}, and thinner in {thinner}. Another "
        "level may have another order."
    )
    if thinner:
        return judged(False, words)
    return judged(True, words) if thicker == len(pairs) else unjudged(words)


class _Width(NamedTuple):
    """Mean difference of two samples and its limits [m]."""

    width: float
    lower: float
    upper: float


def _top_width(case, model):
    """`_Width` at the highest marker of a block; NaN of fewer than three samples."""
    at = case.differences.sel(model=model, marker=list(markers_by_height(case).values())[-1])
    limits = (float(at["width_interval"].sel(bound=bound)) for bound in ("lower", "upper"))
    return _Width(float(at["width"]), *limits)


def parameters_matter(content):
    """Friction, density and stiffness behind the envelopes of LS-DEM."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    shown, seconds, levels = {}, [], []
    for case in content.cases.values():
        top = list(markers_by_height(case).values())[-1]
        result = case.responses["ls-dem"].sensitivity.sel(marker=top)
        beyond = (result["window_first_order"] > result["window_first_order_chance"]).sum("window")
        seconds += [
            f"{case.name} {parameter_label(str(name))} {int(count)}"
            for name, count, control in zip(
                result["parameter"].values, beyond.values, result["control"].values, strict=True
            )
            if count and not control
        ]
        for quantity, measure in (("history", "first_order"), ("peak", "rank_correlation")):
            at = result.sel(quantity=quantity)
            if not is_known(at, measure):
                continue
            found = influences(at, measure)
            levels.append(found.chance)
            for one in found.beyond_chance:
                if not one.control:
                    shown.setdefault(case.name, {})[one.parameter] = None
    if not levels:
        return unjudged("The samples are too few for a sensitivity.")
    told = "; ".join(f"{name}: {', '.join(map(parameter_label, names))}" for name, names in shown.items())
    lacking = [
        words
        for key, words in _MATTER.items()
        if not any(key in name for names in shown.values() for name in names)
    ]
    words = f"Beyond chance at the top{scale_words(content)} over the whole window: {told or 'no variable'}."
    if lacking:
        words += f" Not so: {', '.join(lacking)}."
    if seconds:
        words += f" Beyond chance in so many single seconds: {'; '.join(seconds)}."
    if lacking:
        return unjudged(
            f"{words} Chance alone makes a share or a correlation of {min(levels):.2f} to {max(levels):.2f}; no "
            "evidence of a smaller influence is no evidence against it."
        )
    return judged(True, words)


def residuals(content):
    """Scatter of the residual displacement, largest in configuration 4."""
    if _FOURTH not in content.cases or len(content.cases) < 2:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    shaken = [
        f"{name} at {given(case.settings['duration'])} of {given(_motion_end(content, case))} s"
        for name, case in content.cases.items()
        if case.settings["duration"] < _motion_end(content, case)
    ]
    if shaken:
        return unjudged(f"The runs end while the table still shakes: {', '.join(shaken)}.")
    told, holds = [], True
    for model in content.study["models"]:
        scatter = {}
        for name, case in content.cases.items():
            top = list(markers_by_height(case).values())[-1]
            at = case.responses[model].envelope["residual"].sel(frame="slab", marker=top)
            if int(case.responses[model].envelope.attrs["counted"]) >= SURE_FROM:
                scatter[name] = float(at.sel(quantile=0.95) - at.sel(quantile=0.05))
        if _FOURTH not in scatter or len(scatter) < 2:
            continue  # too few samples
        holds = holds and max(scatter, key=scatter.get) == _FOURTH
        told.append(
            f"{model_label(model)} "
            + ", ".join(f"{name} {millimetres(value)} mm" for name, value in scatter.items())
        )
    if not told:
        return unjudged(f"No model has {SURE_FROM} samples of configuration 4 and of another case.")
    return judged(
        holds,
        f"From the 5 to the 95 % quantile of the residual at the top{scale_words(content)}, by models with at least "
        f"{SURE_FROM} samples: {'; '.join(told)}.",
    )


def _motion_end(content, case):
    """Time at which a case's motion ends [s]."""
    return float(content.motions[case.motion]["time"][-1])
