"""The section of the report on the friction calibration."""

from blockshake.report.blocks import Figure, Section, Table, Text
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.friction_figure import plot_friction
from blockshake.report.wording import given, model_label, number, parameter_label


def friction(content):
    """Which mean friction fits the measured tests, or that they do not tell; None where the study asks for none."""
    if not content.friction:
        return None
    first = next(iter(content.friction.values()))
    variables = " and ".join(parameter_label(name) for name in first["variables"])
    text = (
        f"The mean of {variables} is searched between {given(first['lowest'])} and {given(first['highest'])} (after "
        "Zhou et al. 2023). The score is the continuous ranked probability score of the ensemble against the measured "
        "curves, mean over times and markers: lowest for the distribution that the measurement comes from. A mean is "
        f"refused when its score exceeds the best by more than {first['replicates']} independent designs scatter "
        "(one-sided t test of paired differences, 95 %). What is not refused, the test does not tell from the best. "
        f"Ensembles of {first['size']} samples by {model_label(first['model'])}."
    )
    table = Table(
        "What the tests say of the mean coefficient of friction. Coverage and its leave-one-out reference are "
        "those of the best mean; the residual is the largest of the blocks' median residuals relative to the slab "
        "at the best mean: where next to nothing slid, friction cannot be learnt.",
        ("Case", "Test", "Mean friction is", "Best", "Score [mm]", "Coverage", "Reference", "Residual [mm]"),
        tuple(_row(case, found) for case, found in content.friction.items()),
        "lllrrrrr",
    )
    figure = Figure(
        "Score of the candidate means above that of the best, with the standard error over the designs.",
        svg_of(plot_friction, content.friction),
        PAGE_WIDTH,
    )
    return Section("Friction calibration", "friction", (Text(text), figure, table))


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
