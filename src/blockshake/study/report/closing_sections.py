"""Closing sections: limits and origin."""

import yaml

from blockshake.pages.blocks import Items, Listing, Section
from blockshake.pages.origin import command_blocks, digests_table, pairs_table, versions_table
from blockshake.pages.wording import model_label
from blockshake.pages.words import Words
from blockshake.simulation.models import solver_of
from blockshake.study.ensembles.case_input import COMMANDED
from blockshake.study.report.open_questions import MOST, unknown

_CLOSING = Words(__name__)


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
    driven = {True: [], False: []}
    for name, case in content.cases.items():
        driven[case.settings["input"] == COMMANDED].append(name)
    items = _CLOSING.items(
        "limits",
        random=list(content.distributions),
        measured=driven[False],
        rigid=[model for model in content.study["models"] if solver_of(model).rigid],
        commanded=driven[True],
        unknown=unknown(content)[MOST:],
    )
    return Section("Limits of this study", "limits", (Items(items),))
