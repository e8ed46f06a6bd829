"""The models against each other in computed words."""

from itertools import combinations

import numpy as np

from blockshake.pages.wording import (
    count_words,
    given,
    model_label,
    number,
    share_words,
)
from blockshake.simulation.models import MODELS
from blockshake.study.comparison.tables import in_millimetres, larger_floor


def case_words(case):
    """How far the models of a case are apart, in sentences; a pair of models with rigid blocks at more length."""
    found = case.differences
    pairs = list(combinations(found["model"].values, 2))
    known = {
        pair: float(found["distance"].sel(model=pair[0], other=pair[1]))
        for pair in pairs
        if np.isfinite(found["distance"].sel(model=pair[0], other=pair[1]))
    }
    words = f"{case.name}, {case.motion} x {given(case.settings['scale'])}: "
    chance = {pair: float(found["distance_chance"].sel(model=pair[0], other=pair[1])) for pair in known}
    judged = [pair for pair in known if np.isfinite(chance[pair])]
    if judged:
        beyond = sum(known[pair] > chance[pair] for pair in judged)
        if len(judged) == 1:
            side = "farther apart than by chance" if beyond else "no farther apart than by chance"
            words += f"the ensembles of {_both(judged[0])} are {side}."
        else:
            share = share_words(beyond, len(judged))
            words += f"the ensembles of {share} pairs of models are farther apart than by chance."
        if len(judged) < len(pairs):
            words += f" Too few samples to tell: {count_words(len(pairs) - len(judged), 'further pair')}."
    else:
        words += "too few samples to tell the ensembles of any two models apart."
    if len(known) > 1:
        (near, least), (far, most) = (pick(known.items(), key=lambda one: one[1]) for pick in (min, max))
        words += (
            f" Nearest are {_both(near)} ({in_millimetres(least)} mm), farthest {_both(far)} "
            f"({in_millimetres(most)} mm)."
        )
    for pair in pairs:
        if all(MODELS[model].rigid for model in pair):
            words += f" {_pair_words(found, *pair)}"
    return words


def _both(pair):
    return " and ".join(map(model_label, pair))


def _pair_words(found, own, other):
    """Difference of two models of rigid blocks beside the floor and the horizons of their numerics."""
    at = found.sel(model=own, other=other)
    words = (
        f"{_both((own, other))} both have rigid blocks: the same sample by both differs by "
        f"{in_millimetres(at['history_difference'])} mm (median of {int(at['common'])})"
    )
    floors = [larger_floor(found, model) for model in (own, other)]
    parted = f"the runs {_parted(at['parting_time'])}"
    if not np.isfinite(floors).all() or max(floors) == 0.0:
        return f"{words}; {parted}."
    twins = ", ".join(
        f"those of {model_label(model)} {_parted(found['horizon'].sel(model=model).min('twin', skipna=False))}"
        for model in (own, other)
    )
    ratio = float(at["history_difference"]) / max(floors)
    return (
        f"{words}, {number(ratio, 2)} times the larger floor of their numerics ({in_millimetres(max(floors))} mm); "
        f"{parted}. Of the twins by one model {twins}."
    )


def _parted(time):
    """When curves part, in words."""
    return (
        "are not told apart within the window" if np.isposinf(float(time)) else f"part after {number(time)} s"
    )


def impact_words(cases):
    """Part of the angular velocity that an impact of one block keeps, by model; cases of equal blocks together."""
    told = {}
    for case in cases:
        found = case.differences
        ratios = ", ".join(
            f"{model_label(model)} {number(ratio)}"
            for model, ratio in zip(
                found["model"].values, found["impact_ratio"].sel(step="usual").to_numpy(), strict=True
            )
            if np.isfinite(ratio)
        )
        if ratios:
            words = f"{ratios}; a rigid block on two edges {number(found['housner_ratio'])} (Housner 1963)"
            told.setdefault(words, []).append(case.name)
    return [
        f"Part of the angular velocity that the first impact of one block alone keeps, {', '.join(names)}: {words}."
        for words, names in told.items()
    ]
