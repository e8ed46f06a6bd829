"""The report of a diagnosis of outcomes."""

from blockshake.diagnosis.flight.section import odds_section
from blockshake.diagnosis.outcomes.decide import CAUSES
from blockshake.diagnosis.outcomes.section import answer_section, gain_section, scores_section
from blockshake.diagnosis.verdict.found import document, load_found
from blockshake.effects.registry import title_of
from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import count_words


def compose_outcomes(campaign, results, effort):
    """`Document` of the diagnosis of a campaign of outcomes, from the folder of its results."""
    found = load_found(results)
    tests = count_words(len(campaign.tests), "test")
    subtitle = f"{load_structure(campaign.structure).file.name}, {tests} that it survived or not"
    sections = [section(found) for section in (answer_section, scores_section, gain_section)]
    titles = {cause: title_of(cause) for cause in CAUSES}
    sections.append(odds_section(found.decision, titles, "outcomes"))
    return document(campaign, effort, found, subtitle, sections)
