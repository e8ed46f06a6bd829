"""Sensitivities over all cases and models: the strongest variables, and the paper's discussion in numbers."""

import numpy as np

from blockshake.report.blocks import Table, Text
from blockshake.report.rows import bodies_by_height, face_markers
from blockshake.report.sensitivity_figure import SHOWN
from blockshake.report.sensitivity_words import strength_of, with_interval
from blockshake.report.wording import MISSING, model_label, number


def summary_table(content):
    """The strongest variable of every case and model, at its lowest and highest block, with interval and chance."""
    rows = []
    for case in content.cases.values():
        markers = face_markers(case.structure)
        for model, response in case.responses.items():
            by_height = bodies_by_height(case.structure, markers)
            for body in (by_height[0], by_height[-1]):
                at = response.sensitivity.sel(marker=markers[body])
                quiet = float(at["spread"].sel(quantity="history")) < case.marker_noise
                cells = [
                    "line" if quiet else _strongest(at.sel(quantity=quantity), measure)
                    for measure, (quantity, *_) in SHOWN.items()
                ]
                rows.append(
                    (case.name, model_label(model), body, number(1e3 * at["spread"].sel(quantity="history")), *cells)
                )  # fmt: skip
    return Table(
        "What makes the samples differ, at the lowest and the highest block: spread of the displacement relative to "
        "the slab "
        "(standard "
        "deviation over samples and time); the variable with the largest first-order share of it, and with the "
        "largest "
        "partial rank correlation with the peak, each with its 95 % interval and whether it is beyond the level of "
        "chance in "
        "round brackets. Line: samples that differ by less than a marker's noise.",
        ("Case", "Model", "Block", "Spread [mm]", "Largest share by itself [1]", "Largest rank correlation [1]"),
        tuple(rows), "lllrll",
    )  # fmt: skip


def _strongest(result, measure):
    level = float(result[f"{measure}_chance"])
    if not np.isfinite(level):
        return MISSING
    strength = strength_of(result, measure)
    place = int(np.nanargmax(strength))
    is_beyond = strength[place] > level
    return f"{with_interval(result, measure, place)} ({'beyond' if is_beyond else 'within'} {level:.2f})"


def paper_discussion(content):
    """The paper's two statements on thickness, in numbers: it grows upward, and with the structure."""
    told = []
    for model in content.study["models"]:
        parts, rising = [], 0
        for case in content.cases.values():
            markers = face_markers(case.structure)
            spread = case.responses[model].sensitivity["spread"].sel(quantity="history")
            by_height = [
                float(spread.sel(marker=markers[body])) for body in bodies_by_height(case.structure, markers)
            ]
            rising += bool(np.all(np.diff(by_height) > 0.0))
            parts.append(
                f"{case.name} {number(1e3 * by_height[-1], 2)} and {number(1e3 * by_height[0], 2)} mm"
            )
        told.append(
            f"{model_label(model)}: {', '.join(parts)}; it grows from block to block in {rising} of {len(parts)} "
            f"cases."
        )
    return [
        Text(
            "Zhou et al. (2023) say that envelopes thicken upward and with the complexity of the structure, because "
            "of "
            "friction, density and stiffness. Here the completed samples differ (standard deviation over samples and "
            f"time) at the top and at the foot by: {' '.join(told)} Scales differ between the cases, so that they "
            f"do not "
            "show the effect of the structure alone; which variable it comes from is in the table."
        )
    ]
