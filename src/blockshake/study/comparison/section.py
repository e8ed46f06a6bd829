"""Section that holds the models against each other and against the measured curves."""

from blockshake.pages.blocks import Figure, Heading, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.study.comparison.figure import plot_differences
from blockshake.study.comparison.tables import numerics_table, pairs_table, scores_table
from blockshake.study.comparison.words import case_words, impact_words


def models(content):
    """Distances of every pair of models beside chance and numerics; None where the study has one model."""
    if len(content.study["models"]) < 2:
        return None
    cases = content.cases.values()
    differences = {case.name: case.differences for case in cases}
    blocks = [
        Text(
            "Are two models farther apart than the samples and the numerics of each make them? The distance of two "
            "ensembles is the energy distance of Szekely and Rizzo (2013) at every time, mean over times and blocks: "
            "zero for equal ensembles, and the shift of two narrow ones. Random divisions of the same samples give the "
            "distance that chance makes. Beside it stands the difference of single runs: the same sample by both "
            "models, against a sample and its twin by one model, which differs by less than any test could tell. All "
            "displacements are along x and relative to the slab."
        ),
        Items((*(case_words(case) for case in cases), *impact_words(cases))),
        Figure(
            "Pairs of models by case. Where a dot is within the grey bar, the ensembles are not told apart; where a "
            "diamond is near its cross, the difference of two runs is no larger than that of their numerics.",
            svg_of(plot_differences, differences),
        ),
        pairs_table(content),
        numerics_table(content),
    ]
    scores = scores_table(content)
    if scores is not None:
        blocks += [Heading("Scores against the measured curves", "scores"), scores]
    return Section("Models against each other", "models", tuple(blocks))
