"""Section that holds the models against each other and against the measured curves."""

from itertools import combinations

import numpy as np

from blockshake.pages.blocks import Heading, Items, Section, Text
from blockshake.pages.wording import count_words, model_label, share_words
from blockshake.study.comparison.tables import (
    in_millimetres,
    other_settings_table,
    pairs_table,
    scores_table,
    two_levels_table,
)


def models(content):
    """Distances of every pair of models against chance and numerics; None where the study has one model."""
    if len(content.study["models"]) < 2:
        return None
    blocks = [
        Text(
            "Are two models farther apart than the samples and the numerics of each make them? The distance of two "
            "ensembles is the energy distance of Szekely and Rizzo (2013) at every time, mean over times and blocks: "
            "zero for equal ensembles, and the shift of two narrow ones. Random divisions of the same samples give the "
            "distance that chance makes. With it stands the difference of single runs: the same sample by both "
            "models, against a sample and its twin by one model, which differs by less than any test could tell. All "
            "displacements are along x and relative to the slab."
        ),
        Items(tuple(map(case_words, content.stripes))),
        pairs_table(content),
    ]
    if (prices := other_settings_table(content)) is not None:
        blocks += [Heading("One solver with other settings", "settings"), prices]
    if (helped := two_levels_table(content)) is not None:
        blocks += [Heading("Mean displacement of few samples, with the help of many", "two-levels"), helped]
    scores = scores_table(content)
    if scores is not None:
        blocks += [Heading("Scores against the measured curves", "scores"), scores]
    return Section("Models against each other", "models", tuple(blocks))


def case_words(stripe):
    """How far the models of a case, or of one of its levels, are apart, in sentences."""
    pairs = list(combinations(stripe.differences["model"].values, 2))
    at = {pair: stripe.differences.sel(model=pair[0], other=pair[1]) for pair in pairs}
    distance = {pair: float(at[pair]["distance"]) for pair in pairs if np.isfinite(at[pair]["distance"])}
    beyond = [
        distance[pair] > float(at[pair]["distance_chance"])
        for pair in distance
        if np.isfinite(at[pair]["distance_chance"])
    ]
    words = f"{stripe.name}: "
    if not beyond:
        words += "too few samples to tell the ensembles of any two models apart."
    elif len(pairs) == 1:
        side = "farther" if beyond[0] else "no farther"
        words += f"the ensembles of {_both(pairs[0])} are {side} apart than by chance."
    else:
        share = share_words(sum(beyond), len(beyond))
        words += f"the ensembles of {share} pairs of models are farther apart than by chance."
        if len(beyond) < len(pairs):
            words += f" Too few samples to tell: {count_words(len(pairs) - len(beyond), 'further pair')}."
    if len(distance) > 1:
        near, far = (pick(distance, key=distance.get) for pick in (min, max))
        words += (
            f" Nearest are {_both(near)} ({in_millimetres(distance[near])} mm), farthest {_both(far)} "
            f"({in_millimetres(distance[far])} mm)."
        )
    return words


def _both(pair):
    return " and ".join(map(model_label, pair))
