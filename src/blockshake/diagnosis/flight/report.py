"""The report of a diagnosis of filmed flights."""

from blockshake.diagnosis.flight.section import (
    TITLES,
    answer_section,
    gain_section,
    impacts_section,
    odds_section,
)
from blockshake.diagnosis.verdict.found import document, load_found
from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import count_words


def compose_flights(campaign, results, effort):
    """`Document` of the diagnosis of a campaign without base motion, from the folder of its results."""
    found = load_found(results)
    tests = count_words(len(found.decision.tests), "test")
    subtitle = f"{load_structure(campaign.structure).file.name} over a ground at rest, {tests}"
    sections = [section(found) for section in (answer_section, gain_section, impacts_section)]
    sections.append(odds_section(found.decision, TITLES, "free flights"))
    return document(campaign, effort, found, subtitle, sections)
