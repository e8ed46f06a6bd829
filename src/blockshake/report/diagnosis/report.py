"""The report of a diagnosis: one page and one PDF from the same content."""

from blockshake.report.diagnosis.candidates_section import candidates_section
from blockshake.report.diagnosis.content import load_diagnosed
from blockshake.report.diagnosis.evidence_section import evidence_section
from blockshake.report.diagnosis.extension_section import extension_section
from blockshake.report.diagnosis.forces_section import forces_section
from blockshake.report.diagnosis.gain_section import gain_section
from blockshake.report.diagnosis.limits_section import limits_section
from blockshake.report.diagnosis.misfit_section import misfit_section
from blockshake.report.diagnosis.track_record_section import track_record_section
from blockshake.report.diagnosis.verdict_section import verdict_section
from blockshake.report.document.blocks import Document, numbered
from blockshake.report.document.html import write_html
from blockshake.report.document.pdf import write_pdf

_SECTIONS = (
    verdict_section,
    forces_section,
    misfit_section,
    candidates_section,
    evidence_section,
    extension_section,
    gain_section,
    track_record_section,
    limits_section,
)


def make_diagnosis_report(campaign, results, effort, track_record, html, pdf, horizons=()):
    """Write the report of a diagnosis that has ended.

    Parameters
    ----------
    campaign : str or path
        Folder of the campaign.
    results : str or path
        Folder with its ``verdict.json`` and what that rests on.
    effort : str
        One of `plan.EFFORTS`.
    track_record : str or path
        The procedure's track record; without one the report says so.
    html, pdf : str or path
        To write, each whole or not at all. Same results, same bytes.
    horizons : sequence of str or path, optional
        Files of the tests' predictability, in the order of the readings.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    document = compose_diagnosis(load_diagnosed(campaign, results, effort, track_record, horizons))
    write_html(html, document)
    write_pdf(pdf, document)


def compose_diagnosis(found):
    """The report's document from what was found."""
    return numbered(
        Document(
            title=f"blockshake: diagnosis of {found.campaign.name}",
            subtitle=(
                f"{found.structure}, judged by {len(found.tests)} tests ({', '.join(found.tests)})"
                f", effort {found.effort}"
            ),
            sections=tuple(section(found) for section in _SECTIONS),
        )
    )
