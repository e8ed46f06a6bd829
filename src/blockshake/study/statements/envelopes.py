"""Statements on envelopes: their thickness, residuals, and the variables behind them."""

from itertools import combinations

import numpy as np

from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import (
    given,
    millimetres,
    model_label,
    parameter_label,
    share_words,
)
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.sensitivity.findings import influences, is_known, markers_by_height
from blockshake.study.statements.order import Limited, all_of, ordered
from blockshake.study.statements.statement import judged, missing, scale_words, unjudged

_FIRST, _SECOND, _THIRD, _FOURTH = OF_THE_PAPER
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}
_BRACKET = 0.05 * 9.81  # m/s2; shaking beyond it is strong


def upward(content, model):
    """Thickness from block to block."""
    if absent := missing(content, model):
        return unjudged(absent)
    spreads = {}
    for name, case in content.cases.items():
        chosen = {"quantity": "history", "marker": list(markers_by_height(case).values())}
        spread = case.responses[model].sensitivity["spread"].sel(chosen).to_numpy()
        if np.isfinite(spread).all() and len(spread) > 1:
            spreads[name] = spread
    if not spreads:
        return unjudged("Too few samples completed.")
    grows = [name for name, spread in spreads.items() if (np.diff(spread) > 0.0).all()]
    told = "; ".join(f"{name} {', '.join(map(millimetres, spread))} mm" for name, spread in spreads.items())
    return judged(
        len(grows) == len(spreads),
        f"Standard deviation from the lowest block up{scale_words(content)}: {told}. It grows from each block to the "
        f"next in {share_words(len(grows), len(spreads))} cases. There are no limits: "
        "the blocks of a structure move together in each sample.",
    )


def than_first(content, model):
    """Thickness at the top of configurations 2 to 4 against configuration 1."""
    if absent := missing(content, model):
        return unjudged(absent)
    return _tops(content, model, [(_FIRST, other) for other in OF_THE_PAPER if other != _FIRST])


def fourth_than_third(content, model):
    """Thickness at the top of configuration 4 against configuration 3."""
    return (
        unjudged(absent)
        if (absent := missing(content, model))
        else _tops(content, model, [(_THIRD, _FOURTH)])
    )


def walls_than_stacks(content, model):
    """Thickness at the top of the walls, configurations 3 and 4, against the stacks, 1 and 2."""
    if absent := missing(content, model):
        return unjudged(absent)
    return _tops(
        content, model, [(stack, walls) for stack in (_FIRST, _SECOND) for walls in (_THIRD, _FOURTH)]
    )


def with_structure(content, models):
    """Thickness at the top with the number of blocks, model by model."""
    blocks = {name: int((~load_structure(name).driven).sum()) for name in OF_THE_PAPER}
    pairs = [pair for pair in combinations(OF_THE_PAPER, 2) if blocks[pair[0]] < blocks[pair[1]]]
    return all_of(
        {
            model_label(model): unjudged(absent)
            if (absent := missing(content, model))
            else _tops(content, model, pairs)
            for model in models
        }
    )


def _tops(content, model, pairs):
    """Finding that of each pair of cases the second has the thicker envelope at its top."""
    found = _at_top(content, model, "width")
    return ordered(content, found, pairs, "Mean difference of two samples at the top in mm", millimetres)


def _at_top(content, model, name):
    """A figure of a model's samples at the top with its limits, by case whose samples bear any [m]."""
    found = {}
    for case in content.cases.values():
        top = list(markers_by_height(case).values())[-1]
        at = case.differences.sel(model=model, marker=top)
        limits = at[f"{name}_interval"].transpose("bound").to_numpy()
        if int(at["counted"]) >= SURE_FROM and np.isfinite(limits).all():
            found[case.name] = Limited(float(at[name]), *map(float, limits))
    return found


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
    shaken = [name for name, case in content.cases.items() if _still_shaken(content, case)]
    if shaken:
        return unjudged(
            f"The table shakes by more than {given(_BRACKET / 9.81)} g, the bracket of Bolt (1969), in the last "
            f"{given(RESIDUAL_WINDOW)} s of the runs, whose mean is the residual: {', '.join(shaken)}."
        )
    pairs = [(other, _FOURTH) for other in OF_THE_PAPER if other != _FOURTH]
    return all_of(
        {
            model_label(model): ordered(
                content, _at_top(content, model, "residual_range"), pairs,
                "From the 5 to the 95 % quantile of the residual at the top in mm", millimetres,
            )
            for model in content.study["models"]
        }
    )  # fmt: skip


def _still_shaken(content, case):
    """Whether strong shaking lasts into the window of the residual."""
    motion = content.motions[case.motion]["acceleration"]
    end = case.settings["duration"]
    last = motion.sel(time=slice(end - RESIDUAL_WINDOW, end))
    return bool((abs(case.settings["scale"] * last) > _BRACKET).any())
