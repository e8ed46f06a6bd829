"""Fourth page of a diagnosis: the features that decided, and whether every test asks for the same size."""

from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.figures.evidence import plot_constancy, plot_features
from blockshake.report.diagnosis.law_evidence import decided_by_laws, law_blocks
from blockshake.report.diagnosis.wording import size_in_unit, title_of, with_place
from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import printed, quantity
from blockshake.report.document.wording import model_label, number

_ROWS = 8
_MOST_PANELS = 4


def evidence_section(found):
    """Broken laws and the sizes that they read where laws decided; else features before and after the candidate."""
    if decided_by_laws(found):
        return Section("What decided", "evidence", law_blocks(found))
    rows = found.evidence.isel(row=slice(_ROWS))
    key, model = found.evidence.attrs["candidate"], model_label(found.evidence.attrs["model"])
    caused = bool(found.decision.causes)
    effect = key.partition("@")[0]
    size = quantity(
        size_in_unit(effect, float(found.evidence.attrs["size"])), EFFECTS[effect].parameters[0].unit
    )
    opening = (
        "The features that speak most for the cause"
        if caused
        else "No effect is a cause; these features speak most for the strongest candidate"
    )
    labels = [
        f"{feature}, {test}"
        for feature, test in zip(rows["feature"].values, rows["test"].values, strict=True)
    ]
    shown = found.shown_candidates[:_MOST_PANELS]
    blocks = (
        Text(
            f"{opening}: {with_place(effect, found.places[key])}, at {size}, by {model}, the solver that fits "
            "best. Weight: by how much the square of the residual falls; features go together, so that "
            "weights do not add up to the log ratio. Formulas and units of the features are in docs/diagnosis.md."
        ),
        Figure(
            f"The {rows.sizes['row']} features that weigh most: residual by the nominal model and with the effect.",
            svg_of(plot_features, rows, labels, f"with {title_of(effect)}"),
        ),
        _table(rows),
        Text(
            "A part that the model lacks should have one size in all tests; a part that only makes up for another one "
            "drifts from test to test."
        ),
        Figure(
            "Size that each test finds by itself, with the sizes that are less likely by a factor e squared at most; "
            "axes are as wide as the prior. A test without a bar leaves one of the simulated sizes. "
            + (
                "Blue: all tests together, 90 %."
                if caused
                else "The candidate is no cause, and no size is given."
            ),
            svg_of(plot_constancy, [_panel(found, one) for one in shown]),
        ),
        _constancy_table(found, shown),
    )
    return Section("What decided", "evidence", blocks)


def _table(rows):
    lines = []
    for place in range(rows.sizes["row"]):
        one = rows.isel(row=place)
        lines.append((
            one["feature"].item(), one["test"].item(), quantity(float(one["value"]), one["unit"].item()),
            number(float(one["nominal"])), number(float(one["extended"])), number(float(one["weight"])),
        ))  # fmt: skip
    return Table(
        "The same features: measured value, residuals in standard deviations, weight.",
        ("Feature", "Test", "Measured", "Nominal", "With the effect", "Weight"),
        tuple(lines),
        "llrrrr",
    )


def _panel(found, key):
    row = found.decision.candidate(key)
    first = EFFECTS[row.effect].parameters[0]
    factor, unit = printed(first.unit)

    def shown(size):
        return factor * size_in_unit(row.effect, size)

    ends = [sorted((shown(one.lower), shown(one.upper))) for one in row.by_test]
    own = found.verdict.parameters.get(row.effect, {}).get(first.name)
    return {
        "title": with_place(row.effect, found.places[key]),
        "axis": f"{first.name} [{unit}]",
        "tests": found.tests,
        "estimate": [shown(one.estimate) for one in row.by_test],
        "lower": [low for low, _ in ends],
        "upper": [high for _, high in ends],
        "all": [factor * value for value in (own.estimate, own.lower, own.upper)] if own else None,
        "ends": (factor * first.lower, factor * first.upper),
    }


def _constancy_table(found, keys):
    lines = []
    for key in keys:
        row = found.decision.candidate(key)
        first = EFFECTS[row.effect].parameters[0]
        for test, one in zip(found.tests, row.by_test, strict=True):
            values = [
                quantity(size_in_unit(row.effect, getattr(one, name)), first.unit)
                for name in ("estimate", "lower", "upper")
            ]
            if size_in_unit(row.effect, 1.0) < size_in_unit(row.effect, 0.0):
                values[1:] = values[:0:-1]
            lines.append((with_place(row.effect, found.places[key]), test, *values))
    return Table(
        f"The same sizes. Constancy: {', '.join(_constancy_words(found, key) for key in keys)}.",
        ("Effect and place", "Test", "Size", "From", "To"),
        tuple(lines),
        "llrrr",
    )


def _constancy_words(found, key):
    effect = key.partition("@")[0]
    return f"{title_of(effect)} p = {number(found.decision.constancy[effect], 2)}"
