"""Section that holds the models against each other and against the measured curves."""

from itertools import combinations

import numpy as np

from blockshake.pages.blocks import Heading, Items, Section, Text
from blockshake.pages.words import Words
from blockshake.study.comparison.tables import (
    other_settings_table,
    pairs_table,
    scores_table,
    two_levels_table,
)

_AGAINST = Words(__name__)


def models(content):
    """Distances of every pair of models against chance and numerics; None where the study has one model."""
    if len(content.study["models"]) < 2:
        return None
    blocks = [
        Text(_AGAINST.method()),
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
    distance = {pair: float(one["distance"]) for pair, one in at.items() if np.isfinite(one["distance"])}
    chance = {pair: float(at[pair]["distance_chance"]) for pair in distance}
    tested = {pair: distance[pair] > most for pair, most in chance.items() if np.isfinite(most)}
    ranked = sorted(distance.items(), key=lambda one: one[1]) or [None]
    return _AGAINST.apart(stripe.name, len(pairs), len(tested), sum(tested.values()), ranked[0], ranked[-1])
