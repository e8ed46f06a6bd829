"""Section on the samples: histograms and moments."""

import numpy as np

from blockshake.pages.blocks import Figure, Items, Section, Table, Text
from blockshake.pages.drawing import LIGHT_GREY, RED, new_figure, svg_of
from blockshake.pages.units import printed
from blockshake.pages.wording import count_words, model_label, number, parameter_label, percent
from blockshake.study.sampling.distributions import parameter_unit
from blockshake.study.sampling.sample_parameters import unused_variables

_COLUMNS = 3
_ROW_HEIGHT = 0.044  # m of paper


def samples(content):
    """The design: histograms and moments."""
    summary = content.design_summary
    target = "none" if content.study["ensemble"].get("correlation") is None else "that of the study"
    blocks = (
        Text(
            (
                f"{count_words(summary['size'], 'sample')} of the user's table {content.study['ensemble']['table']}, "
                "in its order."
                if content.study["ensemble"].get("table")
                else f"Latin hypercube of {summary['size']} samples, seed {summary['seed']}; each stratum is "
                f"represented by its {summary['stratum']}. Correlation requested: {target}; the "
                f"{summary['correlation_kind']} correlation differs from it by "
                f"{number(summary['largest_correlation_error'])} at most."
            )
            + (f" The design grew and {content.growth}." if content.growth else "")
            + _without_use(content)
        ),
        Figure(
            "Histograms of the samples and target densities.",
            svg_of(plot_samples, content.design, content.distributions),
        ),
        _table(content),
        *([Items(tuple(fewer))] if (fewer := _fewer_samples(content)) else []),
    )
    return Section("Samples", "samples", blocks)


def _without_use(content):
    """Variables that a model of the study has no use for, in sentences."""
    names, sentences = list(content.distributions), ""
    for model in content.study["models"]:
        unused = unused_variables(names, model, names)
        if unused:
            words = ", ".join(parameter_label(name) for name in unused)
            sentences += f" {model_label(model)} has no use for {words}."
    return sentences


def _fewer_samples(content):
    """One sentence for every model and number of samples below that of the design."""
    size, ran = len(content.design), {}
    for case in content.cases.values():
        for model, one in case.responses.items():
            ran.setdefault((model, one.samples.sizes["sample"]), []).append(case.name)
    sentences = [
        f"{model_label(model)} ran {count} of the {size} samples on {', '.join(names)}."
        for (model, count), names in ran.items()
        if count != size
    ]
    if sentences:
        sentences.append(
            "Bounds of fewer samples are narrower in the mean, and intervals of few hold less often than stated."
        )
    return sentences


def _table(content):
    """Mean and coefficient of variation requested and reached."""
    rows = []
    for name, target in content.distributions.items():
        factor, unit = printed(parameter_unit(name))
        rows.append((
            parameter_label(name), unit, number(factor * target.mean, 4),
            number(factor * content.design_summary["mean"][name], 4), percent(target.cov),
            percent(content.design_summary["cov"][name]),
            ", ".join(one.removeprefix("configuration-") for one in content.users(name)) or "no case",
        ))  # fmt: skip
    return Table(
        "Random variables: mean and coefficient of variation (COV) of the target and of the "
        "samples, and the cases whose structure has the material or the pair.",
        ("Variable", "Unit", "Mean, target", "Mean, samples", "COV, target [%]", "COV, samples [%]", "Cases"),
        tuple(rows), "llrrrrl",
    )  # fmt: skip


def plot_samples(design, distributions):
    """Figure of the density of each sampled variable next to its target: the paper's Fig. 8.

    ``design``: one row a sample, columns the dotted names, SI; ``distributions``: targets by dotted name.
    """
    rows = -(-len(distributions) // _COLUMNS)
    figure = new_figure(_ROW_HEIGHT * rows + 0.008)
    panels = figure.subplots(rows, _COLUMNS, squeeze=False)
    for axes, (name, target) in zip(panels.flat, distributions.items(), strict=False):
        factor, unit = printed(parameter_unit(name))
        _, edges, _ = axes.hist(
            factor * design[name], bins=bin_count(len(design)), density=True, color=LIGHT_GREY,
            edgecolor="#808080", linewidth=0.5, label="samples",
        )  # fmt: skip
        reach = 0.15 * (edges[-1] - edges[0])
        values = np.linspace(edges[0] - reach, edges[-1] + reach, 200)
        axes.plot(values, target.density(values / factor) / factor, color=RED, label="target density")
        axes.set(title=parameter_label(name), xlabel=f"value [{unit}]")
        axes.tick_params(labelleft=False, left=False)
        axes.grid(False)
    for axes in panels.flat[len(distributions) :]:
        axes.set_axis_off()
    for axes in panels[:, 0]:
        axes.set_ylabel("density")
    figure.get_layout_engine().set(hspace=0.06)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2)
    return figure


def bin_count(size):
    """Bins of a histogram of this many samples: their square root, up, and one."""
    return int(np.ceil(np.sqrt(size))) + 1
