"""The report of a study, or of one of its cases: one page and one PDF from the same content."""

from blockshake.pages.blocks import Document, numbered
from blockshake.pages.writing import write_html, write_pdf
from blockshake.study.calibration.section import calibration
from blockshake.study.comparison.section import models
from blockshake.study.extension.section import extension
from blockshake.study.fragility.section import fragility
from blockshake.study.limit_states.section import limit_states
from blockshake.study.report.answer import answer
from blockshake.study.report.closing_sections import limits, origin
from blockshake.study.report.content import load_content
from blockshake.study.report.opening_sections import figures, motions, structures
from blockshake.study.report.result_sections import responses
from blockshake.study.sampling.section import samples
from blockshake.study.sensitivity.indices_section import shares
from blockshake.study.sensitivity.section import sensitivities
from blockshake.study.stiffness.section import stiffness

_SECTIONS = (
    answer,
    limit_states,
    figures,
    structures,
    motions,
    samples,
    stiffness,
    responses,
    fragility,
    models,
    sensitivities,
    shares,
    calibration,
    extension,
    limits,
    origin,
)


def make_report(study, results, html, pdf, case=None):
    """Write the report of a finished study, or of one of its cases.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results : str or path
        Folder of its results.
    html, pdf : str or path
        To write, each whole or not at all. Same results, same bytes.
    case : str, optional
        Name of the case that is reported alone, from its own results.

    Raises
    ------
    InputError
        A results file is missing or holds something else.
    """
    document = compose(load_content(study, results, case))
    write_html(html, document)
    write_pdf(pdf, document)


def compose(content):
    """Document of the content of a study or of one of its cases."""
    return numbered(
        Document(
            title=f"blockshake: {content.study['name']}" + (f", {content.only}" if content.only else ""),
            subtitle=" ".join(content.study["description"].split()),
            details=tuple(
                (name.capitalize(), content.study[name])
                for name in ("project", "author", "date")
                if content.study.get(name)
            ),
            sections=tuple(made for section in _SECTIONS if (made := section(content)) is not None),
        )
    )
