"""Sections on the inputs: summary, structures, motions."""

import numpy as np

from blockshake.dynamics.load_motion import provenance
from blockshake.pages.blocks import Figure, Heading, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import (
    count_words,
    model_label,
)
from blockshake.study.ensembles.outcomes import count_outcomes
from blockshake.study.report.conclusions import conclusions
from blockshake.study.report.figures.motion import plot_motions, plot_spectra
from blockshake.study.report.figures.structure import plot_structure, structure_width
from blockshake.study.report.input_tables import (
    bases_table,
    bodies_table,
    cases_table,
    motions_table,
)
from blockshake.study.report.probability_table import probability_table


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
