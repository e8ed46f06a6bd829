"""Closing sections: limits and origin."""

import yaml

from blockshake.pages.blocks import Items, Listing, Section
from blockshake.pages.origin import command_blocks, digests_table, pairs_table, versions_table
from blockshake.pages.wording import model_label, parameter_label
from blockshake.simulation.models import solver_of
from blockshake.study.ensembles.case_input import COMMANDED
from blockshake.study.report.open_questions import MOST, unknown


def origin(content):
    """Versions, digests, seeds, configuration, and the command that makes the report again."""
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
        *command_blocks("blockshake study FILE" + (f" --case {content.only}" if content.only else "")),
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
        *unknown(content)[MOST:],
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
