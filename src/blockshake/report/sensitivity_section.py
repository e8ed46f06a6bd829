"""The section of the report on what makes the samples differ: figures, words and the summary over cases."""

import numpy as np

from blockshake.report.blocks import Figure, Heading, Section, Table, Text
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.rows import bodies_by_height, face_markers
from blockshake.report.sections import case_title
from blockshake.report.sensitivity_figure import (
    SHOWN,
    has_something,
    plot_sensitivity,
    plot_sensitivity_over_time,
)
from blockshake.report.wording import MISSING, millimetres, model_label, number, parameter_label, percent


def sensitivities(content):
    """Which random variable makes the envelopes thick, case by case and in one table."""
    blocks = [
        Text(
            "Two measures say what the samples' differences come from. The first-order Sobol index of a block's "
            "history is "
            "the share of the thickness of its envelope, as variance over all times, that one variable explains by "
            "itself: a correlation ratio over classes of the variable's ranks, corrected for its bias; five classes "
            "see "
            "0.90 of a linear effect. The partial rank correlation with the peak says how steadily, and in which "
            "direction, the peak follows a variable once the others' part is taken out. Intervals are bootstrap "
            "ones of "
            "95 %. The level of chance is what the largest of all blocks and variables reaches in 95 of 100 random "
            "re-pairings of results and samples: only what stands beyond it is shown to matter. What no single "
            "variable "
            "explains comes from variables acting together, and from motion so sensitive that small differences "
            "decide."
        ),
        *_paper_discussion(content),
        summary_table(content),
    ]
    for case in content.cases.values():
        blocks += _case(case)
    return Section("What makes the envelopes thick", "sensitivity", tuple(blocks))


def _case(case):
    markers = face_markers(case.structure)
    chosen = {body: markers[body] for body in bodies_by_height(case.structure, markers)}
    results = {model: one.sensitivity for model, one in case.responses.items()}
    top = list(chosen)[-1]
    noise = number(1e3 * case.marker_noise)
    blocks = [Heading(case_title(case), f"sensitivity-{case.name}")]
    for model, result in results.items():
        words = sentence(result, top, chosen[top], case.marker_noise)
        blocks.append(Text(f"{model_label(model)}: {words}"))
    drawn = [
        one
        for one in results.values()
        if any(has_something(one, chosen.values(), measure, case.marker_noise) for measure in SHOWN)
    ]
    if not drawn:
        return blocks
    return [
        *blocks,
        Figure(
            f"{case.name}: what each random variable explains of a block's displacement relative to the slab, "
            f"blocks from "
            "the lowest (left) up, of equal ones the first. Dots with 95 % intervals; grey: what chance reaches; "
            "hollow "
            "dots and grey names: controls, variables that model or structure has no use for. Models and measures "
            "that "
            f"have nothing to show are left out: samples that differ by less than a marker's noise ({noise} mm, "
            f"standard "
            "deviation), or too few of them.",
            svg_of(plot_sensitivity, results, chosen, case.marker_noise),
            PAGE_WIDTH,
        ),
        Figure(
            f"{case.name}, {top}: standard deviation over the samples in every second (dashed: a marker's noise), "
            f"and the "
            "share of it that each variable of use explains by itself; grey: what chance reaches in any second, "
            "block "
            "and variable.",
            svg_of(plot_sensitivity_over_time, results, chosen[top], case.marker_noise),
            PAGE_WIDTH,
        ),
    ]


def sentence(result, body, marker, noise):
    """In words, which variable dominates at a block and whether anything is beyond chance.

    Parameters
    ----------
    result : xarray.Dataset
        From `sensitivity`.
    body, marker : str
    noise : float
        Of a measured marker [m].

    Returns
    -------
    str
    """
    history = result.sel(quantity="history", marker=marker)
    if not np.isfinite(history["spread"]):
        return f"{int(history['used'])} completed samples are too few to say what {body} depends on."
    if float(history["spread"]) < noise:
        return (
            f"the samples of {body} differ by {number(1e3 * float(history['spread']), 2)} mm (standard deviation "
            f"over "
            "samples and time), less than a marker's noise: its envelope is a line and there is nothing to explain."
        )
    words = (
        f"the samples of {body} differ by {millimetres(history['spread'])} mm (standard deviation over samples and "
        f"time). "
        f"{_dominating(history, 'first_order')} {_seconds(result.sel(marker=marker), noise)}"
    )
    peak = result.sel(quantity="peak", marker=marker)
    if not np.isfinite(peak["rank_correlation_chance"]):
        return (
            f"{words} {int(peak['used'])} samples are too few for partial correlations of so many variables."
        )
    return (
        f"{words} {_dominating(peak, 'rank_correlation')} All variables together explain "
        f"{percent(peak['explained'])} % of the ranks of the peak (adjusted R\N{SUPERSCRIPT TWO})."
    )


def _seconds(result, noise):
    """In which seconds a variable explains more than chance would."""
    level = float(result["window_first_order_chance"])
    share = result["window_first_order"].where(result["window_spread"] >= noise)
    told = []
    for name in result["parameter"].values:
        one = share.sel(parameter=name)
        beyond = one["window"].values[one.values > level]
        if len(beyond):
            told.append(
                f"{parameter_label(str(name))} in {len(beyond)} (first about {beyond[0]:.1f} s, last "
                f"{beyond[-1]:.1f} s, at "
                f"most {float(one.max()):.2f})"
            )
    if not told:
        return f"In no single second is any share beyond chance ({level:.2f})."
    seconds = int((result["window_spread"] >= noise).sum())
    return f"Of the {seconds} seconds one by one, beyond chance ({level:.2f}): {', '.join(told)}."


def _dominating(result, measure):
    level = float(result[f"{measure}_chance"])
    strength = _strength(result, measure)
    order = np.argsort(-strength, kind="stable")
    first = _with_interval(result, measure, order[0])
    named = ", then ".join(
        _with_interval(result, measure, place) for place in order if strength[place] > level
    )
    if measure == "first_order":
        if named:
            return f"Shown to explain some of that by itself: {named}; chance reaches {level:.2f}."
        return (
            f"No variable is shown to explain any of that by itself: the largest share, {first}, is within "
            f"{level:.2f}, the level of chance."
        )
    if named:
        return f"The peak follows {named} (partial rank correlation; chance reaches {level:.2f})."
    return (
        f"No variable is shown to steer the peak: the largest partial rank correlation, {first}, is within "
        f"{level:.2f}, the level of chance."
    )


def _strength(result, measure):
    """What a variable is ranked by: its share, which is noise where negative, or the size of its correlation."""
    found = result[measure].to_numpy()
    return found if measure == "first_order" else np.abs(found)


def _with_interval(result, measure, place):
    low, high = (float(result[f"{measure}_interval"].sel(bound=one)[place]) for one in ("lower", "upper"))
    name = parameter_label(str(result["parameter"].values[place]))
    unused = ", a control" if int(result["control"][place]) else ""
    return f"{name}{unused} {float(result[measure][place]):.2f} [{low:.2f}, {high:.2f}]"


def summary_table(content):
    """The strongest variable of every case, model and block, with its interval and the level of chance."""
    rows = []
    for case in content.cases.values():
        markers = face_markers(case.structure)
        for model, response in case.responses.items():
            for body in bodies_by_height(case.structure, markers):
                at = response.sensitivity.sel(marker=markers[body])
                quiet = float(at["spread"].sel(quantity="history")) < case.marker_noise
                cells = [
                    "line" if quiet else _strongest(at.sel(quantity=quantity), measure)
                    for measure, (quantity, _, _) in SHOWN.items()
                ]
                rows.append(
                    (case.name, model_label(model), body, millimetres(at["spread"].sel(quantity="history")), *cells)
                )  # fmt: skip
    return Table(
        "What makes the samples differ, blocks from the lowest up: spread of the displacement relative to the slab "
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
    strength = _strength(result, measure)
    place = int(np.nanargmax(strength))
    is_beyond = strength[place] > level
    return f"{_with_interval(result, measure, place)} ({'beyond' if is_beyond else 'within'} {level:.2f})"


def _paper_discussion(content):
    """The paper's two statements on thickness, in numbers: it grows upward, and with the structure."""
    texts = []
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
                f"{case.name} {number(1e3 * by_height[-1], 2)} mm at the top, {number(1e3 * by_height[0], 2)} at "
                f"the foot"
            )
        texts.append(
            Text(
                f"Zhou et al. (2023) say that envelopes thicken upward and with the complexity of the structure. "
                f"{model_label(model)}, "
                f"spread over samples and time: {'; '.join(parts)}. It grows from block to block in {rising} of "
                f"{len(parts)} cases. Motions and scales differ between the cases, so that the cases do not show "
                f"the effect "
                "of the structure alone."
            )
        )
    return texts
