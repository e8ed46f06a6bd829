"""Sections on the inputs: summary, structures, motions, samples, stiffness."""

import numpy as np

from blockshake.dynamics.provenance import provenance
from blockshake.report.document.blocks import Figure, Heading, Items, Section, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import printed
from blockshake.report.document.wording import (
    count_words,
    given,
    model_label,
    number,
    parameter_label,
    percent,
)
from blockshake.report.study.conclusions import conclusions
from blockshake.report.study.figures.motion import plot_motions, plot_spectra
from blockshake.report.study.figures.samples import plot_correlation, plot_samples
from blockshake.report.study.figures.stiffness import plot_stiffness, plot_waves
from blockshake.report.study.figures.structure import plot_structure, structure_width
from blockshake.report.study.input_tables import (
    bases_table,
    bodies_table,
    cases_table,
    motions_table,
    samples_table,
    waves_table,
)
from blockshake.report.study.probability_table import probability_table
from blockshake.study.ensembles.outcomes import count_outcomes
from blockshake.study.sampling.distributions import parameter_unit
from blockshake.study.sensitivity.sensitivity import unused_variables

_ALIKE = 1e-3  # of the mean: values that lie closer print alike


def summary(content):
    """Conclusions, the figures behind them, and the cases."""
    cases = content.cases.values()
    synthetic_tests = [case.name for case in cases if case.synthetic]
    synthetic_motions = sorted(
        {case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")}
    )
    blocks = []
    if synthetic_tests:
        blocks.append(
            Text(
                f"The measured curves of {', '.join(synthetic_tests)} are SYNTHETIC: virtual tests, each one run "
                "simulated by a solver of this program with parameters drawn at random, seen through noisy markers; "
                "an effect that the models here lack may be hidden in them. Nothing was measured there, and the "
                "distance of a model from such a curve tells nothing about reality.",
                strong=True,
            )
        )
    if synthetic_motions:
        blocks.append(
            Text(
                f"The ground motions are synthetic too ({', '.join(synthetic_motions)}): made by a stochastic method, "
                "not recorded.",
                strong=True,
            )
        )
    responses = [one for case in cases for one in case.responses.values()]
    ended = count_outcomes(np.concatenate([one.samples["status"] for one in responses]))
    items = [
        f"{count_words(len(content.cases), 'case')}, {count_words(len(content.study['models']), 'model')} "
        f"({', '.join(model_label(model) for model in content.study['models'])}), {sum(ended)} runs: "
        f"{ended.completed} completed, {ended.collapsed} collapsed, {ended.falling} still falling "
        f"when the window ended, {ended.failed} failed.",
        f"{len(content.design)} samples of {len(content.distributions)} random variables in the design (seed "
        f"{content.study['ensemble']['seed']}).",
    ]
    return Section(
        "Summary",
        "summary",
        (
            *blocks,
            *conclusions(content),
            Heading("Figures behind these sentences", "figures-of-summary"),
            probability_table(content),
            Items(tuple(items)),
            cases_table(content),
        ),
    )


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


def structures(content):
    """Drawing and bodies of each structure."""
    blocks = [
        Text(
            "Configurations 1 to 4: block heights and the 2 cm chamfer are those of Zhou et al. (2023). The paper does "
            "not state, and the structure files infer, the block's length of 2.4 m and its orientation, the size of "
            "the slab, the gap between the walls, section, length and places of the steel beams, and the places of "
            "markers and accelerometers."
        )
        if any(case.is_shipped for case in content.cases.values())
        else Text("Sizes are those of the structure files.")
    ]
    alike = {}
    for case in content.cases.values():
        alike.setdefault(case.settings["structure"], []).append(case)
    for case, *others in alike.values():
        names = ", ".join(one.name for one in (case, *others))
        blocks += [
            Heading(names, f"structure-{case.name}"),
            Figure(
                f"{names}: {case.structure.file.description}. Sizes in m"
                + (", some of them inferred (see above)" if case.is_shipped else "")
                + ". The faces towards the reader are those at the lowest y (front view) and the largest x (side "
                "view); sensors on hidden faces are drawn too.",
                svg_of(plot_structure, case.structure),
                structure_width(case.structure),
            ),
            bodies_table(case.structure, names),
        ]
    return Section("Structures", "structures", tuple(blocks))


def motions(content):
    """Histories, spectra and figures of the motions."""
    used = {}
    for case in content.cases.values():
        used.setdefault(content.motions[case.motion].attrs["name"], set()).add(case.settings["duration"])
    lasts = {one.attrs["name"]: float(one["time"][-1]) for one in content.motions.values()}
    cut = {name: sorted(end for end in ends if end < lasts[name]) for name, ends in used.items()}
    cut = {name: ends for name, ends in cut.items() if ends}
    unused = [
        name for name in content.motions if name not in {case.motion for case in content.cases.values()}
    ]
    data = list(content.motions.values())
    blocks = [
        Text(
            "Motions at 100 %; the cases multiply them by their scale."
            + (
                f" No case of this study uses {', '.join(unused)}, which the ladder of intensities names."
                if unused
                else ""
            )
        ),
        Items(tuple(f"{one.attrs['name']}: {provenance(one.attrs)}." for one in data)),
        Figure(
            "Ground acceleration, velocity and displacement along x (after the paper's Fig. 5)"
            + ("; dashed: end of the window that the cases simulate." if cut else "."),
            svg_of(plot_motions, data, cut),
        ),
        Figure(
            "Response spectra at 5 % damping"
            + (
                ", with the ordinates that a synthetic motion aims at."
                if any("target" in one for one in data)
                else "."
            ),
            svg_of(plot_spectra, data),
        ),
        motions_table(content.motions),
        *([bases_table(content)] if any(case.base is not None for case in content.cases.values()) else []),
    ]
    return Section("Ground motions", "motions", tuple(blocks))


def samples(content):
    """The design: histograms, moments, correlation."""
    found = content.design_summary
    target = (
        "none" if content.study["ensemble"].get("correlation") is None else "as given in the configuration"
    )
    blocks = (
        Text(
            f"Latin hypercube of {found['size']} samples, seed {found['seed']}; each stratum is represented by its "
            f"{found['stratum']}.{_without_use(content)}"
        ),
        Figure(
            "Histograms of the samples and target densities (after the paper's Fig. 8).",
            svg_of(plot_samples, content.design, content.distributions),
        ),
        samples_table(content),
        *([Items(tuple(fewer))] if (fewer := _fewer_samples(content)) else []),
        Figure(
            f"{found['correlation_kind'].capitalize()} correlation reached between the variables; asked for: {target}. "
            f"Difference from the target over the pairs: {number(found['rms_correlation_error'])} rms, "
            f"{number(found['largest_correlation_error'])} at most.",
            svg_of(
                plot_correlation,
                found["correlation"],
                [parameter_label(one) for one in content.distributions],
            ),
            0.15,
        ),
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


def stiffness(content):
    """Waves, their speed, and the stiffness of every sample, for each kind of blocks; None where the study has none."""
    if not content.calibrated:
        return None
    waves = content.calibrated[0].waves
    blocks = [
        Text(
            "The contact stiffness of LS-DEM follows for every sample from the speed of waves in a tower of "
            f"{waves.sizes['block']} of the structure's blocks, matched to that of the material of the sample (Zhou et "
            f"al. 2023, Eqs. 7 and 8). Definition: {waves.attrs['definition']}."
        )
    ]
    for calibrated in content.calibrated:
        of = f"; {', '.join(calibrated.cases)}" if len(content.calibrated) > 1 else ""
        blocks += [
            Figure(
                "Displacement of the blocks of the tower after a step of velocity of "
                f"{given(1e3 * calibrated.waves.attrs['step_velocity'])} mm/s at its base, nominal parameters{of}; "
                "dots: arrivals (after the paper's Fig. 9).",
                svg_of(plot_waves, calibrated.waves),
            ),
            waves_table(calibrated.waves, of),
            _stiffness_of_samples(calibrated.stiffness, of),
        ]
    blocks.append(Text("The stiffness by other definitions of arrival and dampings: docs/uncertainty.md."))
    return Section("Contact stiffness", "stiffness", tuple(blocks))


def _stiffness_of_samples(stiffness, of):
    """Histograms of the stiffness of the samples, or their one value."""
    caption = f"Stiffness per area of the {len(stiffness)} samples{of}"
    mean, spread = stiffness.mean(), stiffness.max() - stiffness.min()
    if (spread > _ALIKE * mean).any():
        return Figure(f"{caption} (after the paper's Fig. 10).", svg_of(plot_stiffness, stiffness))
    values = []
    for name, value in mean.items():
        factor, unit = printed(parameter_unit(name))
        values.append(f"{parameter_label(name)} {number(factor * value)} {unit}")
    return Text(f"{caption}: {', '.join(values)}, the same in all within {percent(_ALIKE)} %.")
