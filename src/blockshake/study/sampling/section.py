"""Section on the samples: histograms and moments."""

from blockshake.pages.blocks import Figure, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.units import printed
from blockshake.pages.wording import count_words, model_label, number, parameter_label, percent
from blockshake.study.sampling.distributions import parameter_unit
from blockshake.study.sampling.figure import plot_samples
from blockshake.study.sampling.sample_parameters import unused_variables


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
                f"represented by its {summary['stratum']}. Correlation asked for: {target}; the "
                f"{summary['correlation_kind']} correlation differs from it by "
                f"{number(summary['largest_correlation_error'])} at most."
            )
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
    """One sentence for every model and number of samples below that of the design, with the cost of a sample."""
    size, ran = len(content.design), {}
    cost = {(one.model, one.case): one.cpu_time / one.samples for one in content.timings if one.samples}
    for case in content.cases.values():
        for model, one in case.responses.items():
            ran.setdefault((model, one.samples.sizes["sample"]), []).append(case.name)
    sentences = []
    for (model, count), names in ran.items():
        if count == size:
            continue
        costs = sorted(cost[model, name] for name in names if (model, name) in cost)
        each = " to ".join(dict.fromkeys(number(one, 2) for one in (costs[:1] + costs[-1:])))
        sentences.append(
            f"{model_label(model)} ran {count} of the {size} samples on {', '.join(names)}"
            + (f", where a sample cost {each} CPU s." if costs else ".")
        )
    if sentences:
        sentences.append(
            "Bounds of fewer samples are narrower in the mean, and intervals of few hold less often than stated."
        )
    return sentences


def _table(content):
    """Mean and coefficient of variation asked for and reached."""
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
