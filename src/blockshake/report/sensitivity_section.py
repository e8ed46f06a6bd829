"""The section of the report on what makes the samples differ: figures, words and the summary over cases."""

from blockshake.report.blocks import Figure, Heading, Section, Text
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.rows import bodies_by_height, face_markers
from blockshake.report.sections import case_title
from blockshake.report.sensitivity_figure import (
    SHOWN,
    has_something,
    plot_sensitivity,
    plot_sensitivity_over_time,
)
from blockshake.report.sensitivity_summary import paper_discussion, summary_table
from blockshake.report.sensitivity_words import sentence
from blockshake.report.wording import model_label, number


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
        *paper_discussion(content),
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
