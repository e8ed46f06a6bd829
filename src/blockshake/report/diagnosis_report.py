"""The report of a diagnosis: one page and one PDF from the same content."""

from blockshake.report.blocks import Document, numbered
from blockshake.report.diagnosis_candidates_section import candidates_section
from blockshake.report.diagnosis_content import load_diagnosed
from blockshake.report.diagnosis_evidence_section import evidence_section
from blockshake.report.diagnosis_extension_section import extension_section
from blockshake.report.diagnosis_gain_section import gain_section
from blockshake.report.diagnosis_licence_section import licence_section
from blockshake.report.diagnosis_limits_section import limits_section
from blockshake.report.diagnosis_misfit_section import misfit_section
from blockshake.report.diagnosis_verdict_section import verdict_section
from blockshake.report.html import write_html
from blockshake.report.pdf import write_pdf

_SECTIONS = (
    verdict_section,
    misfit_section,
    candidates_section,
    evidence_section,
    extension_section,
    gain_section,
    licence_section,
    limits_section,
)


def make_diagnosis_report(campaign, results, effort, licence, html, pdf, horizons=()):
    """Write the report of a diagnosis that has ended.

    Parameters
    ----------
    campaign : str or path
        Folder of the campaign.
    results : str or path
        Folder with its ``verdict.json`` and what that rests on.
    effort : str
        One of `plan.EFFORTS`.
    licence : str or path
        The procedure's licence; without one the report says so.
    html, pdf : str or path
        To write, each whole or not at all. Same results, same bytes.
    horizons : sequence of str or path, optional
        Files of the tests' predictability, in the order of the readings.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    document = compose_diagnosis(load_diagnosed(campaign, results, effort, licence, horizons))
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
