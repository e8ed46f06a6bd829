"""Closing sections: completion and energy, timings, limits and origin."""

import numpy as np
import yaml

from blockshake.pages.blocks import Items, Listing, Section, Table, Text
from blockshake.pages.origin import command_blocks, digests_table, pairs_table, versions_table
from blockshake.pages.wording import MISSING, model_label, number, parameter_label
from blockshake.simulation.models import solver_of
from blockshake.study.ensembles.case_input import COMMANDED
from blockshake.study.ensembles.outcomes import numerical_figure, unfinished
from blockshake.study.ensembles.timing import total_timing


def checks(content):
    """Samples that did not complete, energy, and figures of the computation."""
    failures = _failures_table(content)
    blocks = [
        failures if failures.rows else Text("Every sample of every case and model completed."),
        Text(
            "Energy residual: the largest difference of the sum of kinetic, potential, elastic and dissipated energy "
            "from the sum of the initial energy and the work of the base, relative to the larger of that work and the "
            "largest kinetic energy. It measures the error of the time stepping; 0 is exact."
        ),
    ]
    for model in content.study["models"]:
        words = [Text(_COMPUTATION[model])] if model in _COMPUTATION else []
        blocks += [*words, _computation_table(content, model)]
    blocks.append(
        Text(
            "LS-DEM with other time steps, nodes and grids in two short runs: docs/method.md. Rigid NSCD beside "
            "LMGC90, the program of Zhou et al. (2023): docs/results/peers.md."
        )
    )
    return Section("Completion, energy and computation", "checks", tuple(blocks))


_COMPUTATION = {
    "ls-dem": (
        "LS-DEM is explicit and does not iterate. Its steps are fixed; settling steps bring the stack to rest under "
        "its own weight before a run; the search for near pairs is repeated when bodies have moved far enough."
    ),
    "nscd-rigid": (
        "NSCD solves the contact problem of each step by iteration. The relative residual is the error of the solution "
        "in the contact laws; a capped step stopped at the iteration limit before its tolerance. Iterations of a step "
        "are those of its parts together. Penetration is the error of the scheme in the gaps."
    ),
    "nscd-elastic": (
        "The blocks of this model deform, without viscosity: the steps are those of NSCD. Vibrations faster than the "
        "step are damped by the scheme, and the energy that it takes from them is listed."
    ),
    "nscd-viscoelastic": (
        "The blocks of this model deform with the viscous modulus of Table 2, read as Pa s. The steps are those of "
        "NSCD; what the scheme takes is listed, and the viscosity of the material takes the rest."
    ),
}


def _failures_table(content):
    """Samples that did not complete, with the reason."""
    rows = [
        (
            case.name, model_label(model), str(int(one["sample"])), str(one["status"].values),
            number(one["end_time"]), str(one["reason"].values),
        )
        for case in content.cases.values()
        for model, response in case.responses.items()
        for one in unfinished(response.samples)
    ]  # fmt: skip
    return Table(
        "Samples that did not complete. Samples that collapsed, or still fell when the window ended, count in the "
        "statistics up to their end; failed samples do not.",
        ("Case", "Model", "Sample", "Status", "End [s]", "Reason"), tuple(rows), "llrlrl",
    )  # fmt: skip


def _computation_table(content, model):
    """Figures of a solver's computation; figures that none of its runs holds are left out."""
    by_case = {case.name: case.responses[model].samples for case in content.cases.values()}
    wanted = [entry for entry in _FIGURES if any(entry[0] in one for one in by_case.values())]
    rows = []
    for case, samples in by_case.items():
        cells = (
            number(factor * numerical_figure(samples, name, statistic))
            for name, _, factor, statistic in wanted
        )
        rows.append((case, *cells))
    return Table(
        f"{model_label(model)}: figures of the computation over the samples of a case.",
        ("Case", *(label for _, label, _, _ in wanted)), tuple(rows), "l" + "r" * len(wanted),
    )  # fmt: skip


# of any solver; each writes those that it has
_FIGURES = (
    ("energy_residual", "Energy residual, median [1]", 1.0, np.median),
    ("energy_residual", "Energy residual, largest [1]", 1.0, np.max),
    ("numerics_steps", "Steps of a run", 1.0, np.max),
    ("numerics_mean_iterations", "Iterations a step, median of the runs' means", 1.0, np.median),
    ("numerics_max_iterations", "Most iterations", 1.0, np.max),
    ("numerics_capped_steps", "Most capped steps of a run", 1.0, np.max),
    ("numerics_max_residual", "Largest relative residual", 1.0, np.max),
    ("numerics_fraction_above_1e-4", "Largest share of steps above 1e-4 [%]", 100.0, np.max),
    ("numerics_max_penetration", "Deepest penetration [mm]", 1e3, np.max),
    ("numerics_energy_lost_to_scheme", "Most energy lost to the scheme [J]", 1.0, np.max),
    ("numerics_settling_steps", "Most settling steps before a run", 1.0, np.max),
    ("numerics_list_searches", "Most searches for near pairs", 1.0, np.max),
)


def timings(content):
    """Cost of the simulations."""
    blocks = (
        Text(
            "CPU time includes the loading of compiled code, not the start of each job and its imports. It is that of "
            "the last run of each job: samples that this run took from the store of finished samples cost almost "
            f"nothing, and the figures are then too low. '{MISSING}' stands where no log tells the cost."
        ),
        _timings_table(content),
    )
    return Section("Timings", "timings", blocks)


def _timings_table(content):
    """CPU time of the simulations."""
    rows = []
    for one in (*content.timings, total_timing(content.timings)):
        rows.append((
            one.case, model_label(one.model), str(one.jobs), str(one.samples),
            *(number(value) for value in (one.simulated, one.cpu_time, one.wall_time, one.cpu_per_simulated)),
        ))  # fmt: skip
    rows[-1] = ("all", "", *rows[-1][2:-1], "")
    return Table(
        "Cost of the simulations on one core each, from the jobs' logs.",
        (
            "Case", "Model", "Jobs", "Samples", "Simulated [s]", "CPU [s]", "Wall [s]",
            "CPU per simulated second [1]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def origin(content):
    """Versions, digests, seeds, configuration, and the command that makes the report again."""
    name = content.name
    sources = {}
    for case in content.cases.values():
        for model, one in case.responses.items():
            attributes = one.samples.attrs
            sources.setdefault(model_label(model), set()).add(
                f"{attributes['source_digest']} (blockshake {attributes['blockshake_version']})"
            )
    configuration = yaml.safe_dump(
        {**content.study, "description": " ".join(content.study["description"].split())},
        sort_keys=False, allow_unicode=True, width=100,
    )  # fmt: skip
    blocks = (
        versions_table(content.versions),
        pairs_table(
            "Digests of the sources that simulated.",
            ("Model", "Source digest"),
            {model: ", ".join(sorted(digests)) for model, digests in sources.items()},
        ),
        digests_table(content.digests),
        *command_blocks(f"snakemake -c2 reports/{name}.html reports/{name}.pdf --configfile FILE"),
        Text(
            "Command that shows which job made each result, with its code, parameters and times, in a page of its own:"
        ),
        Listing("Provenance", "snakemake --report provenance.html --configfile FILE"),
        Listing("Configuration used, the content of FILE", configuration),
    )
    return Section("Origin", "origin", blocks)


def limits(content):
    """Limits of the study."""
    cases = content.cases.values()
    random = [parameter_label(name) for name in content.distributions]
    measured, commanded = (
        ", ".join(case.name for case in cases if (case.settings["input"] == COMMANDED) == is_commanded)
        for is_commanded in (False, True)
    )
    if measured:
        random.append(f"the motion of the slab within the error of its readings ({measured})")
    rigid = [model_label(model) for model in content.study["models"] if solver_of(model).rigid]
    items = [
        "Friction is Coulomb's, with one coefficient a pair of materials, constant in time, place and rate.",
        f"Random are: {'; '.join(random)}. Sizes, places and the condition of the joints are taken as known.",
        "Structures have no imperfections; responses are shown along x only.",
        "The convergence of the cases with time step and discretisation is not shown.",
    ]
    if rigid:
        items.append(
            f"Blocks are rigid in {' and '.join(rigid)}: no deformation inside a block, no cracking, no crushing of "
            "edges."
        )
    if commanded:
        items.append(
            f"The models of {commanded} are driven by the commanded motion, not by that of the slab."
        )
    return Section("Limits of this study", "limits", (Items(tuple(items)),))
