"""Second page of a diagnosis: where, when and by how much the nominal model is wrong."""

from blockshake.diagnosis.misfit.misfit import where
from blockshake.diagnosis.misfit.ranking import worst_curves, worst_joints
from blockshake.report.diagnosis.figures.atlas import plot_atlas
from blockshake.report.diagnosis.figures.joint import plot_joints
from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import count_words, number, percent

_MOST_JOINTS = 5  # rows that a page has room for beside its text
_MOST_CURVES = 24
_MOST_PANELS = 4
_ATLAS = (
    "Residual atlas: root mean square of each joint's motion to either side (+, -) in the quiet phase, while shaken "
    "strongly and after, less its mean over the nominal ensemble, in the ensemble's standard deviations. Red: farther "
    "than simulated, blue: less far. Numbers stand beyond the limit that any cell of a test exceeds in 5 of 100 cases "
    "where nothing is missing. Grey: the test has no such phase, or the residual is not known."
)
_LAWS = {
    "proportional": "in proportion to the intensity of the tests",
    "faster": "faster than the intensity of the tests",
    "slower": "slower than the intensity of the tests",
    "threshold": "in the stronger tests alone",
}


def misfit_section(found):
    """Curves of the joints, the atlas and the scores of every curve."""
    misfit, joints = found.misfit, worst_joints(found.misfit, _MOST_JOINTS)
    blocks = [Text(_summary(found))]
    for first in range(0, len(found.tests), _MOST_PANELS):
        tests = found.tests[first : first + _MOST_PANELS]
        blocks.append(Figure(_ATLAS, svg_of(plot_atlas, misfit, tests, joints)))
    left_out = misfit.sizes["joint"] - len(joints)
    for test in found.tests:
        horizon = found.horizon.get(test)
        blocks.append(
            Figure(
                f"{test}: motion of the joints and the nominal ensemble of both solvers (5 to 95 %, median). Red: "
                "outside the band, as one tenth of all readings are by chance. Single "
                "readings beyond the axes are cut off."
                + _horizon_words(found, horizon)
                + (f" {left_out} joints with smaller residuals are not drawn." if left_out else ""),
                svg_of(plot_joints, misfit, found.readings, test, joints, horizon, found.measured_word),
            )
        )
    blocks.append(_curves_table(misfit))
    return Section("Where the tests depart from the nominal model", "misfit", tuple(blocks))


def _summary(found):
    misfit = found.misfit
    text = (
        f"Whole curves of all joints in all {len(found.tests)} tests held against the nominal ensemble at once "
        f"(extreme rank length): p = {number(float(misfit['p_curves']), 2)}. "
        + (
            "No cell of the residual atlas is beyond its limit."
            if misfit.attrs["phase"] == "none"
            else f"First misfit, in the earliest phase with a cell of the atlas beyond its limit: {where(misfit)}."
        )
    )
    if misfit.attrs["law"] in _LAWS:
        text += f" It grows {_LAWS[misfit.attrs['law']]}."
    return text


def _horizon_words(found, horizon):
    if not found.horizon:
        return " How long the test can be predicted was not measured."
    if horizon is None:
        return ""
    return (
        f" Shaded: from {number(horizon, 2)} s on, runs that start apart by no more than what is measured can tell "
        "have parted visibly; single curves are no evidence there."
    )


def _curves_table(misfit):
    worst, rows = worst_curves(misfit, _MOST_CURVES), []
    for curve in worst.names:
        own = misfit.sel(curve=curve)
        rows.append((
            curve, percent(own["coverage"]), " / ".join(percent(one) for one in own["coverage_reference"].values),
            number(own["sharpness"], 2), number(1e3 * own["crps"]),
            " / ".join(number(1e3 * one, 2) for one in own["crps_reference"].values),
        ))  # fmt: skip
    return Table(
        f"Curves that the nominal ensemble predicts worst, {len(rows)} of {worst.known}, the worst first by score over "
        "that of the members; joint 1 is the lowest. Inside the band for less time than 95 % of the members are: "
        f"{count_words(worst.below_reference, 'curve')}. Coverage of the band from smallest to largest member, mean "
        "width of the band over the largest measured magnitude, continuous ranked probability score (lower is better; "
        "mm or mrad). Leave-one-out: each member against the others, 5 / 50 / 95 %.",
        (
            "Curve",
            "Coverage [%]",
            "its leave-one-out [%]",
            "Width over peak [1]",
            "CRPS",
            "its leave-one-out",
        ),
        tuple(rows),
        "lrrrrr",
    )
