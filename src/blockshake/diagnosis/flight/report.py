"""The report of a diagnosis of filmed flights."""

from blockshake.diagnosis.answer.decision import load_decision
from blockshake.diagnosis.flight.section import (
    TITLES,
    FoundFlights,
    answer_section,
    gain_section,
    impacts_section,
    odds_section,
)
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.files import file_digest
from blockshake.geometry.structure import load_structure
from blockshake.pages.blocks import Document, Section, numbered
from blockshake.pages.origin import command_blocks, digests_table, software_versions, versions_table
from blockshake.pages.wording import count_words
from blockshake.store import load_made


def compose_flights(campaign, results):
    """`Document` of the diagnosis of a campaign without base motion.

    Parameters
    ----------
    campaign : Campaign
    results : Path
        Folder with ``verdict.json`` and what it rests on.
    """
    verdict = load_verdict(results / "verdict.json")
    gain = results / "gain.nc" if verdict.gain else None
    decision = load_decision(results / "decision.json")
    found = FoundFlights(
        verdict=verdict,
        decision=decision,
        evidence=load_made(results / "evidence.nc"),
        gain=load_made(gain) if gain else None,
    )
    sections = [section(found) for section in (answer_section, gain_section, impacts_section)]
    sections.append(odds_section(decision, TITLES, "free flights"))
    sections.append(origin(campaign, results, gain))
    structure = load_structure(campaign.structure)
    return numbered(
        Document(
            title=f"blockshake: diagnosis of {campaign.name}",
            subtitle=f"{structure.file.name} over a ground at rest, {count_words(len(decision.tests), 'test')}",
            sections=tuple(section for section in sections if section),
        )
    )


def origin(campaign, results, gain):
    """`Section` of the command, the digests of the files, and the versions; ``gain``: path of ``gain.nc`` or None."""
    files = [
        campaign.folder / "campaign.yaml",
        *(results / name for name in ("decision.json", "evidence.nc", "verdict.json")),
    ]
    files += [gain] if gain else []
    digests = {"/".join(path.parts[-2:]): file_digest(path) for path in files}
    return Section(
        "Origin", "origin",
        (
            *command_blocks("snakemake -c2 diagnose --config campaign=FOLDER"),
            digests_table(digests), versions_table(software_versions()),
        ),
    )  # fmt: skip
