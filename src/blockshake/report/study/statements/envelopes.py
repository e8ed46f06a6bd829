"""Statements on envelopes: their thickness, residuals, and the variables behind them."""

from itertools import combinations

import numpy as np
from scipy.stats import bootstrap

from blockshake.files import content_digest
from blockshake.geometry.structure import load_structure
from blockshake.report.document.wording import (
    given,
    millimetres,
    model_label,
    parameter_label,
    share_words,
)
from blockshake.report.study.sensitivity.summary import markers_by_height, thickness_by_case
from blockshake.report.study.statements.order import Limited, all_of, ordered
from blockshake.report.study.statements.statement import judged, missing, scale_words, unjudged
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.intervals import SURE_FROM
from blockshake.study.sensitivity.findings import influences, is_known

_FIRST, _SECOND, _THIRD, _FOURTH = OF_THE_PAPER
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}
_BRACKET = 0.05 * 9.81  # m/s2; shaking beyond it is strong
_DRAWS = 400  # of the bootstrap


def upward(content, model):
    """Thickness from block to block."""
    if absent := missing(content, model):
        return unjudged(absent)
    known = {
        name: one
        for name, one in thickness_by_case(content, model).items()
        if one.known and len(one.spread) > 1
    }
    if not known:
        return unjudged("Too few samples completed.")
    grows = [name for name, one in known.items() if one.grows_upward]
    told = "; ".join(
        f"{name} {', '.join(millimetres(spread) for spread in one.spread)} mm" for name, one in known.items()
    )
    return judged(
        len(grows) == len(known),
        f"Standard deviation from the lowest block up{scale_words(content)}: {told}. It grows from each block to the "
        f"next in {share_words(len(grows), len(known))} cases. There are no limits: "
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
    found = {}
    for name, case in content.cases.items():
        if int(case.differences["counted"].sel(model=model)) >= SURE_FROM:
            top = list(markers_by_height(case).values())[-1]
            at = case.differences.sel(model=model, marker=top)
            found[name] = Limited(float(at["width"]), *map(float, at["width_interval"].transpose("bound")))
    return ordered(content, found, pairs, "Mean difference of two samples at the top in mm", millimetres)


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
                content, _scatter(content, model), pairs,
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


def _scatter(content, model):
    """Range of the residual at the top by case, with bootstrap limits [m]."""
    found = {}
    for name, case in content.cases.items():
        samples = counted_samples(case.responses[model].samples)
        top = list(markers_by_height(case).values())[-1]
        values = samples["residual"].sel(frame="slab", marker=top).dropna("sample").values
        if len(values) >= SURE_FROM:
            rng = np.random.default_rng(int(content_digest("scatter", name, model), 16))
            drawn = bootstrap((values,), _range, method="percentile", n_resamples=_DRAWS, rng=rng)
            found[name] = Limited(float(_range(values)), *map(float, drawn.confidence_interval))
    return found


def _range(values, axis=-1):
    lower, upper = np.quantile(values, (0.05, 0.95), axis=axis)
    return upper - lower
