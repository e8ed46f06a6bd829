"""Section on the causes of the differences between samples: figures and words."""

from blockshake.pages.blocks import Figure, Heading, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import model_label, number
from blockshake.study.sensitivity.figure import SHOWN, is_shown, plot_sensitivity
from blockshake.study.sensitivity.findings import (
    markers_by_height,
    motion_sentences,
    sentence,
    shared_words,
)


def sensitivities(content):
    """Influence of each random variable on the thickness of the envelopes, case by case."""
    of_motion = tuple(motion_sentences(content))
    blocks = [
        *([Items(of_motion)] if of_motion else []),
        Text(
            "Two measures tell where the differences between samples come from. The first-order Sobol index of the "
            "history of a block is the share of the thickness of its envelope, as variance over all times, that one "
            "variable explains by itself: a correlation ratio over classes of the ranks of the variable, corrected for "
            "its bias. Of n samples there are n^0.4 classes: five for 50, which see 0.90 of a linear effect, and two "
            "for 8, which see less. The partial rank correlation with the peak tells how "
            "steadily, and in which direction, the peak follows a variable once the part of the others is taken out. "
            "Intervals are bootstrap intervals of 95 %. The level of chance is the largest value over all blocks and "
            "variables that 95 of 100 random pairings of results and samples stay below: only a value beyond it is "
            "shown to matter. Samples that failed are in no measure. Those that fell are not in the history, and rank "
            "first in the peak. Variables that act together, the motion of the slab where each sample draws it within "
            "the error of its readings, and sensitivity of the motion to small differences explain the rest. Where the "
            "ranks of two variables have a correlation r among the completed samples, asked for or left by few, each "
            "index holds a part of the other's, which is not parted: a variable without an effect of its own then has "
            "up to r squared of the other's share."
        ),
        Items(_shared(content)),
    ]
    for case in content.cases.values():
        blocks += _case(case)
    return Section("Causes of the thickness of the envelopes", "sensitivity", tuple(blocks))


def _shared(content):
    """Samples that did not complete, and variables that share their indices, in a sentence for cases alike."""
    told = {}
    for case in content.cases.values():
        for model, one in case.responses.items():
            history, peak = (int(one.sensitivity["used"].sel(quantity=name)) for name in ("history", "peak"))
            size = one.samples.sizes["sample"]
            less = f" ({size} samples, of which {history} for the history, {peak} for the peak)" * (
                history < size
            )
            told.setdefault(shared_words(one.sensitivity), []).append(
                f"{case.name} by {model_label(model)}{less}"
            )
    return tuple(f"{', '.join(names)}: {words}." for words, names in told.items())


def _case(case):
    chosen = markers_by_height(case)
    results = {model: one.sensitivity for model, one in case.responses.items()}
    top = list(chosen)[-1]
    noise = number(1e3 * case.marker_noise)
    blocks = [Heading(case.title, f"sensitivity-{case.name}")]
    for model, result in results.items():
        words = sentence(result, top, chosen[top], case.marker_noise)
        blocks.append(Text(f"{model_label(model)}: {words}"))
    shown = [
        measure
        for measure in SHOWN
        if any(is_shown(one, chosen.values(), measure, case.marker_noise) for one in results.values())
    ]
    return [
        *blocks,
        *(
            Figure(
                f"{case.name}: {SHOWN[measure][1].removesuffix(' [1]')}, of each random variable, for the displacement "
                "of a block relative to the slab, blocks from the lowest (left) up, of equal ones the first. Dots with "
                "95 % intervals; grey: level of chance; hollow dots and grey names: controls, variables that model or "
                "structure has no use for. Models with nothing to show are left out: samples that differ by less than "
                f"the noise of a marker ({noise} mm, standard deviation), or too few of them.",
                svg_of(plot_sensitivity, results, chosen, case.marker_noise, measure),
            )
            for measure in shown
        ),
    ]
