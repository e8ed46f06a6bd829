"""The sections of the report on what was put in: summary, structures, motions, samples, stiffness."""

from pathlib import Path

from blockshake.report.blocks import Figure, Heading, Items, Section, Text
from blockshake.report.definition_tables import definition_blocks
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.input_tables import (
    bodies_table,
    cases_table,
    motions_table,
    outcome_counts,
    samples_table,
    waves_table,
)
from blockshake.report.motion_figure import plot_motions, plot_spectra
from blockshake.report.result_tables import top_block_table
from blockshake.report.samples_figure import plot_correlation, plot_samples
from blockshake.report.stiffness_figure import plot_stiffness, plot_waves
from blockshake.report.structure_figure import plot_structure, structure_width
from blockshake.report.wording import given, model_label, number, parameter_label


def summary(content):
    """What was simulated, with which data, how it ended and the peaks of the top blocks."""
    cases = content.cases.values()
    synthetic_tests = [case.name for case in cases if case.synthetic]
    synthetic_motions = sorted(
        {case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")}
    )
    blocks = []
    if synthetic_tests:
        blocks.append(
            Text(
                "The measured curves are SYNTHETIC: virtual tests, each one simulated run with parameters drawn at "
                "random, made by a solver of this program and seen through noisy markers; an effect that the models "
                "here lack may be hidden in them. Nothing was measured; how near a model comes to them says nothing "
                "about reality. "
                f"This holds for {', '.join(synthetic_tests)}.",
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
    runs = sum(one.samples.sizes["sample"] for case in cases for one in case.responses.values())
    counts = [outcome_counts(one.samples) for case in cases for one in case.responses.values()]
    completed, collapsed, failed = (sum(column) for column in zip(*counts, strict=True))
    items = [
        f"{len(content.cases)} structures, {len(content.study['models'])} models "
        f"({', '.join(model_label(model) for model in content.study['models'])}), {runs} runs: {completed} completed, "
        f"{collapsed} collapsed, {failed} failed.",
        f"{len(content.design)} samples of {len(content.distributions)} random variables in the design (seed "
        f"{content.study['ensemble']['seed']}).",
        *_fewer_samples(content),
    ]
    return Section(
        "Summary", "summary", (*blocks, Items(tuple(items)), cases_table(content), top_block_table(content))
    )


def _fewer_samples(content):
    """One statement for every case that a model ran with fewer samples than the design has."""
    size = len(content.design)
    return [
        f"{model_label(model)} ran {one.samples.sizes['sample']} of the {size} samples on {case.name}: its extremes "
        "reach less far for that alone."
        for case in content.cases.values()
        for model, one in case.responses.items()
        if one.samples.sizes["sample"] < size
    ]


def structures(content):
    """Each structure drawn, and its bodies."""
    blocks = [
        Text(
            "Block heights and the 2 cm chamfer are those of Zhou et al. (2023). Inferred, because the paper does not "
            "state them: the block's 2.4 m and its orientation, the slab's size, the gap between the walls, section, "
            "length and places of the steel beams, and the places of markers and accelerometers."
        )
        if _paper_structures(content)
        else Text("Sizes are those of the structure files.")
    ]
    for case in content.cases.values():
        blocks += [
            Heading(case.name, f"structure-{case.name}"),
            Figure(
                f"{case.name}: {case.structure.file.description}. Sizes in m"
                + (", some of them inferred (see above)" if _is_shipped(case) else "")
                + ". The faces towards the reader are those at the lowest y (front view) and the largest x (side "
                "view); sensors on hidden faces are drawn too.",
                svg_of(plot_structure, case.structure),
                structure_width(case.structure),
            ),
            bodies_table(case),
        ]
    return Section("Structures", "structures", tuple(blocks))


def _is_shipped(case):
    return case.settings["structure"].startswith("configuration-")


def _paper_structures(content):
    return any(_is_shipped(case) for case in content.cases.values())


def motions(content):
    """Histories, spectra and figures of the motions."""
    used = {}
    for case in content.cases.values():
        used.setdefault(content.motions[case.motion].attrs["name"], set()).add(case.settings["duration"])
    windows = {name: sorted(durations) for name, durations in used.items()}
    unused = [
        name for name in content.motions if name not in {case.motion for case in content.cases.values()}
    ]
    data = list(content.motions.values())
    blocks = [
        Text(
            "Motions at 100 %; the cases multiply them by their scale. "
            + (
                f"No case of this study uses {', '.join(unused)}: the ladder of intensities does."
                if unused
                else ""
            )
        ),
        Items(tuple(f"{one.attrs['name']}: {one.attrs.get('source', '')}." for one in data)),
        Figure(
            "Ground acceleration, velocity and displacement along x (after the paper's Fig. 5); dashed: end of the "
            "window that the cases simulate.",
            svg_of(plot_motions, data, windows),
            PAGE_WIDTH,
        ),
        Figure(
            "Response spectra at 5 % damping, with the ordinates that the synthesis aims at.",
            svg_of(plot_spectra, data),
            PAGE_WIDTH,
        ),
        motions_table(content.motions),
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
            f"{found['stratum']}. The solvers of this study take their blocks as rigid: the viscous moduli do not act "
            "in them, and Young's moduli act through LS-DEM's contact stiffness only."
        ),
        Figure(
            "Histograms of the samples and target densities (after the paper's Fig. 8).",
            svg_of(plot_samples, content.design, content.distributions),
            PAGE_WIDTH,
        ),
        samples_table(content),
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


def stiffness(content):
    """Waves, their speed, and the stiffness of every sample."""
    definition = content.waves.attrs["definition"]
    blocks = (
        Text(
            "LS-DEM's contact stiffness follows for every sample from the speed of waves in a tower of four blocks, "
            "matched to that of the sample's material (Zhou et al. 2023, Eqs. 7 and 8). "
            f"Definition: {definition}."
        ),
        Figure(
            "Displacement of the blocks of the tower after a step of velocity of "
            f"{given(1e3 * content.waves.attrs['step_velocity'])} mm/s at its base, nominal parameters; "
            "dots: arrivals (after the paper's Fig. 9).",
            svg_of(plot_waves, content.waves),
            PAGE_WIDTH,
        ),
        waves_table(content.waves),
        Figure(
            f"Stiffness per area of the {len(content.stiffness)} samples (after the paper's Fig. 10).",
            svg_of(plot_stiffness, content.stiffness),
            PAGE_WIDTH,
        ),
        *definition_blocks(content.definitions),
    )
    return Section("Contact stiffness", "stiffness", blocks)


def case_title(case):
    """A case's name with what it is."""
    return f"{Path(case.settings['structure']).stem}: {case.structure.file.description}"
