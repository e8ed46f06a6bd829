"""Results of a diagnosis that rests on one kind of readings alone, such as flights or outcomes, for its report."""

from pathlib import Path
from typing import NamedTuple

import xarray as xr

from blockshake.diagnosis.answer.decision import Decision, load_decision
from blockshake.diagnosis.answer.thresholds import ODDS
from blockshake.diagnosis.verdict.verdict import Verdict, load_verdict
from blockshake.diagnosis.wording import estimate_in_si, times_words
from blockshake.files import file_digest
from blockshake.pages.blocks import Document, Section, Table, numbered
from blockshake.pages.origin import command_blocks, digests_table, software_versions, versions_table
from blockshake.pages.wording import number
from blockshake.store import load_made


class Found(NamedTuple):
    """Verdict, decision, evidence against what was measured, and scores on sealed tests (None where none were
    measured).

    ``folder`` is that of the results.
    """

    folder: Path
    verdict: Verdict
    decision: Decision
    evidence: xr.Dataset
    gain: xr.Dataset | None


def load_found(folder):
    """`Found` of a folder with ``verdict.json`` and what it rests on."""
    folder = Path(folder)
    verdict = load_verdict(folder / "verdict.json")
    return Found(
        folder=folder,
        verdict=verdict,
        decision=load_decision(folder / "decision.json"),
        evidence=load_made(folder / "evidence.nc"),
        gain=load_made(folder / "gain.nc") if verdict.gain else None,
    )


def cause_words(cause, title):
    """A cause with its body and its sizes in their own units."""
    sizes = ", ".join(f"{name} {estimate_in_si(one)}" for name, one in cause.parameters.items())
    return f"{title}, {cause.place['body']} ({sizes})"


def odds_section(decision, titles, readings):
    """Odds and gains of all rivals, one table a cause; None where nothing acts.

    ``titles`` has the words for a cause by its name, and ``readings`` states what the odds rest on.
    """
    blocks = []
    for part in decision.parts:
        rows = tuple(
            (titles[name], _less_likely(part, name), number(part.gains[name]))
            for name in sorted(part.odds, key=part.odds.get)
        )
        blocks.append(
            Table(
                f"How many times less likely each cause is than {titles[part.causes[0].name]}, the most probable, by "
                f"{readings} alone, and its log Bayes factor over no cause [nats].",
                ("Cause", "Less likely", "Gain"), rows, "lrr",
            )
        )  # fmt: skip
    return Section("Odds of all causes", "odds", tuple(blocks)) if blocks else None


def _less_likely(part, name):
    if name == part.causes[0].name:
        return "the most probable"
    return "not distinguished" if part.odds[name] < ODDS else times_words(part.odds[name])


def document(campaign, effort, found, subtitle, sections):
    """`Document` of sections, those that are None left out, with the origin of all as the last one."""
    return numbered(
        Document(
            title=f"blockshake: diagnosis of {campaign.name}",
            subtitle=subtitle,
            sections=(*(section for section in sections if section), _origin(campaign, effort, found)),
        )
    )


def _origin(campaign, effort, found):
    names = ["decision.json", "evidence.nc", "verdict.json", *(["gain.nc"] if found.gain is not None else [])]
    files = [campaign.folder / "campaign.yaml", *(found.folder / name for name in names)]
    digests = {"/".join(path.parts[-2:]): file_digest(path) for path in files}
    return Section(
        "Origin", "origin",
        (
            *command_blocks(f"snakemake -c2 diagnose --config campaign=FOLDER effort={effort}"),
            digests_table(digests), versions_table(software_versions()),
        ),
    )  # fmt: skip
