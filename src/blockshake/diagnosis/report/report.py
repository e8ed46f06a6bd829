"""The report of a diagnosis: one page and one PDF from the same content."""

from blockshake.diagnosis.gain.section import effect_section, gain_section
from blockshake.diagnosis.misfit.section import misfit_section
from blockshake.diagnosis.report.answer_section import answer_section
from blockshake.diagnosis.report.content import load_diagnosed
from blockshake.diagnosis.report.history_section import history_section
from blockshake.diagnosis.report.limits_section import limits_section
from blockshake.diagnosis.report.odds_section import odds_section
from blockshake.diagnosis.report.origin_section import origin_section
from blockshake.diagnosis.report.sensors_section import sensors_section
from blockshake.diagnosis.report.size_section import size_section
from blockshake.diagnosis.verdict.track_record_section import track_record_section
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.pages.blocks import Document, numbered
from blockshake.pages.wording import count_words
from blockshake.pages.writing import write_html, write_pdf

_SECTIONS = (
    answer_section,
    odds_section,
    size_section,
    history_section,
    gain_section,
    sensors_section,
    misfit_section,
    limits_section,
    track_record_section,
    effect_section,
    origin_section,
)


def make_diagnosis_report(campaign, results, effort, track_record, html, pdf):
    """Write the report of a diagnosis that has ended.

    Parameters
    ----------
    campaign : str or path
        Folder of the campaign.
    results : str or path
        Folder with its ``verdict.json`` and what that rests on.
    effort : str
    track_record : str or path
        The procedure's track record; without one the report states it.
    html, pdf : str or path
        To write, each whole or not at all. Same results, same bytes.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    measured = load_campaign(campaign)
    document = measured.kind.compose(measured, results, effort, track_record)
    write_html(html, document)
    write_pdf(pdf, document)


def compose_shaken(campaign, results, effort, track_record):
    """`Document` of the diagnosis of a campaign with base motion, from the folder of its results."""
    return compose_diagnosis(load_diagnosed(campaign.folder, results, effort, track_record))


def compose_diagnosis(diagnosed):
    """The report's document from what was found; a section that has nothing to say is left out."""
    tests, count = diagnosed.decision.tests, len(diagnosed.decision.moved)
    moved = f", of which joints moved in {count}" if count < len(tests) else ""
    sections = (section(diagnosed) for section in _SECTIONS)
    return numbered(
        Document(
            title=f"blockshake: diagnosis of {diagnosed.campaign.name}",
            subtitle=(
                f"{diagnosed.structure}, judged by {count_words(len(tests), 'test')} ({', '.join(tests)})"
                f"{moved}, effort {diagnosed.effort}"
            ),
            sections=tuple(section for section in sections if section),
        )
    )
