"""The report of a diagnosis of outcomes."""

from blockshake.diagnosis.answer.decision import load_decision
from blockshake.diagnosis.flight.report import origin
from blockshake.diagnosis.flight.section import odds_section
from blockshake.diagnosis.outcomes.decide import CAUSES
from blockshake.diagnosis.outcomes.section import (
    FoundOutcomes,
    answer_section,
    gain_section,
    scores_section,
)
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.effects.registry import title_of
from blockshake.geometry.structure import load_structure
from blockshake.pages.blocks import Document, numbered
from blockshake.pages.wording import count_words
from blockshake.store import load_made


def compose_outcomes(campaign, results):
    """`Document` of the diagnosis of a campaign of outcomes.

    Parameters
    ----------
    campaign : Campaign
    results : Path
        Folder with ``verdict.json`` and what it rests on.
    """
    verdict = load_verdict(results / "verdict.json")
    gain = results / "gain.nc" if verdict.gain else None
    found = FoundOutcomes(
        verdict=verdict,
        decision=load_decision(results / "decision.json"),
        evidence=load_made(results / "evidence.nc"),
        gain=load_made(gain) if gain else None,
    )
    sections = [section(found) for section in (answer_section, scores_section, gain_section)]
    titles = {cause: title_of(cause) for cause in CAUSES}
    sections.append(odds_section(found.decision, titles, "outcomes"))
    sections.append(origin(campaign, results, gain))
    structure = load_structure(campaign.structure)
    return numbered(
        Document(
            title=f"blockshake: diagnosis of {campaign.name}",
            subtitle=f"{structure.file.name}, {count_words(len(campaign.tests), 'test')} that it survived or not",
            sections=tuple(section for section in sections if section),
        )
    )
