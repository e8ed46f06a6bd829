"""Section on the friction calibration."""

from blockshake.report.document.blocks import Figure, Items, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import given, model_label, number, parameter_label
from blockshake.report.study.figures.friction import plot_friction
from blockshake.study.friction.calibration import LEVEL


def friction(content):
    """Mean friction that fits the measured tests, if they tell it; None where the study asks for none."""
    if not content.friction:
        return None
    first = next(iter(content.friction.values()))
    variables = "; ".join(parameter_label(name) for name in first["variables"])
    text = (
        f"The mean friction ({variables}) is searched between {given(first['lowest'])} and "
        f"{given(first['highest'])} (after Zhou et al. 2023). The score is the continuous ranked probability score of "
        "the ensemble against the measured curves, mean over times and markers; it is lowest for the distribution that "
        "the measurement comes from. A mean is refused when its score exceeds the best by more than "
        f"{first['replicates']} independent designs scatter (one-sided t test of paired differences, "
        f"{100 * LEVEL:.0f} %). A mean that is not refused cannot be told from the best. Ensembles of {first['size']} "
        f"samples by {model_label(first['model'])}."
    )
    table = Table(
        "Mean coefficient of friction by the tests. Coverage and its leave-one-out reference are those of the mean of "
        "lowest score. The residual is the largest of the blocks' median residuals relative to the slab at that mean; "
        "small residuals carry little information on friction.",
        (
            "Case",
            "Test",
            "Mean friction is",
            "Lowest score at",
            "Score [mm]",
            "Coverage",
            "Reference",
            "Residual [mm]",
        ),
        tuple(_row(case, found) for case, found in content.friction.items()),
        "lllrrrrr",
    )
    figure = Figure(
        "Score of the candidate means above that of the best, with the standard error over the designs.",
        svg_of(plot_friction, content.friction),
    )
    scores = Items(tuple(_scores(case, found) for case, found in content.friction.items()))
    return Section("Friction calibration", "friction", (Text(text), scores, figure, table))


def _scores(case, found):
    """How far apart the scores of the means are, in a sentence."""
    scores = [1e3 * score for score in found["means"]["score"]]
    return (
        f"{case}: the scores of the means lie between {number(min(scores), 4)} and {number(max(scores), 4)} mm, "
        f"{number(max(scores) - min(scores), 2)} mm apart."
    )


def _row(case, found):
    means = found["means"]
    best = means["mean"].index(found["best"])
    return (
        case,
        "synthetic" if found["synthetic"] else "measured",
        found["answer"],
        given(found["best"]),
        number(1e3 * means["score"][best]),
        number(means["coverage"][best]),
        number(means["reference"][best]),
        number(1e3 * means["residual"][best]),
    )
