"""The sections of the report on what came out: responses, checks, timings, origin and limits."""

import numpy as np
import yaml

from blockshake.report.blocks import Figure, Heading, Items, Listing, Section, Text
from blockshake.report.displacement_figure import plot_displacements
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.probability_table import probability_table
from blockshake.report.result_tables import (
    convergence_table,
    coverage_table,
    energy_table,
    failures_table,
    pairs_table,
    peaks_table,
    timings_table,
)
from blockshake.report.rows import face_markers, main_bodies
from blockshake.report.sections import case_title
from blockshake.report.wording import given, model_label, number

_PAPER_FIGURES = {f"configuration-{place}": 10 + place for place in (1, 2, 3, 4)}


def responses(content):
    """Displacement of the blocks by both models, case by case."""
    blocks = [
        Text(
            "Displacement along x of a marker on each block's side face, from the top block down. Grey is what the "
            "samples fill, red their smallest and largest value at each time. Two bounds of n samples hold one "
            "further run of the same model at one instant with probability (n - 1) / (n + 1); for a whole record no "
            "probability is stated, which is why every coverage stands beside its leave-one-out reference."
        )
    ]
    if "nscd-rigid" in content.study["models"]:
        blocks.append(
            Text(
                "Rigid NSCD has no contact stiffness, and the density of equal blocks cancels from its equations: "
                "where nothing slips all its samples are nearly the same run and its band closes to a line."
            )
        )
    blocks.append(probability_table(content))
    for case in content.cases.values():
        blocks += _response(case, content.motions[case.motion])
    return Section("Displacement of the blocks", "responses", tuple(blocks))


def _response(case, motion):
    markers = face_markers(case.structure)
    main = main_bodies(case.structure, markers)
    envelopes = {model: one.envelope for model, one in case.responses.items()}
    word = "virtual test (synthetic)" if case.synthetic else "measured curve"
    paper = (
        f" (after the paper's Fig. {_PAPER_FIGURES[case.name]})"
        if case.name in _PAPER_FIGURES and case.settings["structure"] == case.name
        else ""
    )
    some = "" if len(main) == len(markers) else "; all blocks are in the next figure"

    def figure(bodies, frame, caption):
        chosen = [markers[body] for body in bodies]
        drawn = svg_of(plot_displacements, envelopes, case.measured, chosen, bodies, frame, case.synthetic)
        return Figure(caption, drawn, PAGE_WIDTH)

    return [
        Heading(case_title(case), f"response-{case.name}"),
        Text(
            f"{case.motion}, scale {given(case.settings['scale'])}, first {given(case.settings['duration'])} s. "
            f"Marker noise of the {word}: {given(1e3 * case.marker_noise)} mm (standard deviation)."
        ),
        *_early_end(case, motion),
        *_gaps(case),
        figure(main, "inertial", f"{case.name}: displacement in the inertial frame{paper}{some}."),
        peaks_table(case),
        coverage_table(case),
        figure(
            list(markers), "slab", f"{case.name}: displacement relative to the slab's marker, every block."
        ),
    ]


def _early_end(case, motion):
    """A remark where the window ends within the motion."""
    if case.settings["duration"] >= motion.attrs["duration"]:
        return []
    return [
        Text(
            f"The window ends before the motion, which lasts {given(motion.attrs['duration'])} s (strong until "
            f"{number(motion.attrs['significant_end'])} s): the residuals below are displacements at that moment, "
            "not of a structure at rest."
        )
    ]


def _gaps(case):
    """How many samples contribute where some stopped early."""
    texts = []
    for model, one in case.responses.items():
        there = one.envelope["contributing"].values
        counted = int(one.envelope.attrs["counted"])
        fewer = np.flatnonzero(there < counted)
        if counted and len(fewer):
            since = float(one.envelope["time"][fewer[0]])
            texts.append(
                Text(
                    f"{model_label(model)}: {counted} samples contribute until {number(since)} s, {int(there[-1])} at "
                    "the end; bounds and quantiles are of those that contribute, and peaks of collapsed samples are "
                    "lower limits."
                )
            )
        if counted < int(one.envelope.attrs["samples"]):
            missing = int(one.envelope.attrs["samples"]) - counted
            texts.append(
                Text(f"{model_label(model)}: {missing} failed samples are left out of the statistics.")
            )
    return texts


def checks(content):
    """Samples that did not complete, energy and convergence."""
    failures = failures_table(content)
    blocks = [
        failures if failures.rows else Text("Every sample of every case and model completed."),
        Text(
            "Energy residual: the largest amount by which kinetic, potential, elastic and dissipated energy differ "
            "from the initial energy and the work of the base, relative to the larger of that work and the largest "
            "kinetic energy. It holds what the time stepping and the bookkeeping lose or add; 0 would be exact."
        ),
        energy_table(content),
    ]
    for model, text in _MEANING.items():
        if model in content.study["models"]:
            blocks += [Text(text), convergence_table(content, model)]
    return Section("Completion, energy and convergence", "checks", tuple(blocks))


_MEANING = {
    "nscd-rigid": (
        "NSCD solves the contact problem of each step by iteration. The relative residual is what its answer misses "
        "the contact laws by; a capped step stopped at the iteration limit before its tolerance; a run with too many "
        "steps above a residual of 1e-4 counts as failed. Penetration is what the scheme lets through."
    ),
    "ls-dem": (
        "LS-DEM is explicit: nothing iterates. Its steps are fixed; settling steps bring the stack to rest under its "
        "own weight before a run; the search for near pairs is repeated when bodies have moved far enough."
    ),
}


def timings(content):
    """What the simulations cost."""
    blocks = (
        Text(
            "CPU time includes each job's start and the loading of compiled code. It is that of the jobs' last run: "
            "samples then taken from the store of finished runs cost almost nothing, and the figures are too low by "
            "them. "
            f"'{number(np.nan)}' stands where a benchmark file is missing."
        ),
        timings_table(content),
    )
    return Section("Timings", "timings", blocks)


def origin(content):
    """Versions, digests, seeds, configuration, how to run the study again."""
    name = content.study["name"]
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
        },
    }
    configuration = yaml.safe_dump(
        {**content.study, "description": " ".join(content.study["description"].split())},
        sort_keys=False, allow_unicode=True, width=100,
    )  # fmt: skip
    blocks = (
        pairs_table("Software that made this report.", ("Package", "Version"), content.versions),
        pairs_table(
            "Digests of the sources that simulated.",
            ("Model", "Source digest"),
            {model: ", ".join(sorted(digests)) for model, digests in sources.items()},
        ),
        pairs_table("Digests of files (first 12 digits of SHA-256).", ("File", "Digest"), content.digests),
        pairs_table(
            "Seeds; those of the motions stand with their sources above.", ("What", "Seed"), _alike(seeds)
        ),
        Text(
            "To run it again, put the configuration below in a file and call, in a checkout of the same version:"
        ),
        Listing("Command", f"snakemake -c2 reports/{name}.html reports/{name}.pdf --configfile FILE"),
        Listing("Configuration used", configuration),
    )
    return Section("Origin", "origin", blocks)


def _alike(seeds):
    """Seeds that are all the same become one row."""
    first = "design of the samples"
    others = {key: value for key, value in seeds.items() if key != first}
    if len(set(others.values())) == 1:
        others = {"noise in the coverage reference": next(iter(others.values()))}
    return {first: seeds[first], **others}


def limits(content):
    """What the study does not hold."""
    cases = content.cases.values()
    items = [
        "Blocks are rigid in every model here: no deformation inside a block, no cracking, no crushing of edges.",
        "Friction is Coulomb's with one coefficient a pair of materials, constant in time, place and rate.",
        "Shaking is along x only and the structures have no imperfections; where they are symmetric about y = 0, no "
        "motion out of the plane arises.",
        "Only material parameters are random. Sizes, places, the joints' condition and the input motion are taken as "
        "known.",
        "Late parts of records of strong rocking are sensitive to the smallest differences: single histories are no "
        "evidence there, statistics over samples are steadier.",
        "The convergence of these cases' own results with time step and discretisation is not shown in this report"
        + ("; the annex has that of two short runs by LS-DEM." if content.convergence is not None else "."),
    ]
    if any(case.synthetic for case in cases):
        items.insert(
            0,
            "The measured curves are virtual tests (synthetic), made by a model of this program: the comparison "
            "exercises the method and cannot show what the models get wrong.",
        )
    if any(content.motions[case.motion].attrs.get("synthetic") for case in cases):
        items.insert(1, "The motions are synthetic stand-ins for records that may not be redistributed.")
    if any(case.settings["structure"].startswith("configuration-") for case in cases):
        items.append(
            "Several sizes of the structures are inferred, not stated in the source (see Structures)."
        )
    return Section("What is not in this study", "limits", (Items(tuple(items)),))
