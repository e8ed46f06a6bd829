"""Closing sections: completion and energy, timings, limits and origin."""

import yaml

from blockshake.pages.blocks import Items, Listing, Section, Text
from blockshake.pages.origin import command_blocks, digests_table, pairs_table, versions_table
from blockshake.pages.wording import MISSING, model_label, parameter_label
from blockshake.simulation.models import MODELS
from blockshake.study.ensembles.case_input import COMMANDED
from blockshake.study.report.result_tables import (
    computation_table,
    energy_table,
    failures_table,
    timings_table,
)


def checks(content):
    """Samples that did not complete, energy, and figures of the computation."""
    failures = failures_table(content)
    blocks = [
        failures if failures.rows else Text("Every sample of every case and model completed."),
        Text(
            "Energy residual: the largest difference of the sum of kinetic, potential, elastic and dissipated energy "
            "from the sum of the initial energy and the work of the base, relative to the larger of that work and the "
            "largest kinetic energy. It measures the error of the time stepping; 0 is exact."
        ),
        energy_table(content),
    ]
    for model in content.study["models"]:
        words = [Text(_COMPUTATION[model])] if model in _COMPUTATION else []
        blocks += [*words, computation_table(content, model)]
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


def timings(content):
    """Cost of the simulations."""
    blocks = (
        Text(
            "CPU time includes the loading of compiled code, not the start of each job and its imports. It is that of "
            "the last run of each job: samples that this run took from the store of finished samples cost almost "
            f"nothing, and the figures are then too low. '{MISSING}' stands where no log tells the cost."
        ),
        timings_table(content),
    )
    return Section("Timings", "timings", blocks)


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
    seeds = {
        "design of the samples": content.study["ensemble"]["seed"],
        **{
            f"noise in the coverage reference, {case.name}, {model_label(model)}": one.comparison.attrs[
                "noise_seed"
            ]
            for case in content.cases.values()
            for model, one in case.responses.items()
            if one.comparison is not None
        },
    }
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
        pairs_table(
            "Seeds; those of the motions stand with their sources above.", ("Use", "Seed"), _alike(seeds)
        ),
        *command_blocks(f"snakemake -c2 reports/{name}.html reports/{name}.pdf --configfile FILE"),
        Text(
            "Command that shows which job made each result, with its code, parameters and times, in a page of its own:"
        ),
        Listing("Provenance", "snakemake --report provenance.html --configfile FILE"),
        Listing("Configuration used, the content of FILE", configuration),
    )
    return Section("Origin", "origin", blocks)


def _alike(seeds):
    """One row for seeds that are all the same."""
    first = "design of the samples"
    others = {key: value for key, value in seeds.items() if key != first}
    if len(set(others.values())) == 1:
        others = {"noise in the coverage reference": next(iter(others.values()))}
    return {first: seeds[first], **others}


def _drawn_motion(cases):
    """The slab's motion, where each sample draws it from the error of its readings."""
    measured = [case.name for case in cases if case.settings["input"] != COMMANDED]
    return (
        [f"the motion of the slab within the error of its readings ({', '.join(measured)})"]
        if measured
        else []
    )


def limits(content):
    """Limits of the study."""
    cases = content.cases.values()
    items = []
    if any(case.synthetic for case in cases):
        items.append(
            "The measured curves are virtual tests (synthetic), made by a model of this program, perhaps with an "
            "effect that the models of the study lack: the comparison exercises the method and tells nothing of real "
            "blocks."
        )
    synthetic = sorted({case.motion for case in cases if content.motions[case.motion].attrs.get("synthetic")})
    if synthetic:
        items.append(f"Synthetic, and no recorded motions: {', '.join(synthetic)}.")
    rigid = [model_label(model) for model in content.study["models"] if MODELS[model].rigid]
    if rigid:
        items.append(
            f"Blocks are rigid in {' and '.join(rigid)}: no deformation inside a block, no cracking, no crushing of "
            "edges."
        )
    items += [
        "Friction is Coulomb's, with one coefficient a pair of materials, constant in time, place and rate.",
        f"Random are: {'; '.join([*map(parameter_label, content.distributions), *_drawn_motion(cases)])}. Sizes, "
        "places and the condition of the joints are taken as known.",
        "Structures have no imperfections; responses are shown along x only.",
    ]
    commanded = [case.name for case in cases if case.settings["input"] == COMMANDED]
    if commanded:
        items.append(
            f"The models of {', '.join(commanded)} are driven by the commanded motion, not by that of the slab."
        )
    items.append("The convergence of the cases with time step and discretisation is not shown.")
    if any(case.is_shipped for case in cases):
        items.append(
            "Several sizes of the structures are inferred, not stated in the source (see Structures)."
        )
    return Section("Limits of this study", "limits", (Items(tuple(items)),))
