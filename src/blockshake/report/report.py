"""The report of a study: one page and one PDF from the same content."""

from blockshake.report.blocks import Document, numbered
from blockshake.report.content import load_content
from blockshake.report.convergence_section import convergence
from blockshake.report.friction_section import friction
from blockshake.report.html import write_html
from blockshake.report.pdf import write_pdf
from blockshake.report.peer_section import peer
from blockshake.report.result_sections import checks, limits, origin, responses, timings
from blockshake.report.sections import motions, samples, stiffness, structures, summary
from blockshake.report.sensitivity_section import sensitivities

_SECTIONS = (
    summary,
    structures,
    motions,
    samples,
    stiffness,
    responses,
    sensitivities,
    friction,
    checks,
    timings,
    limits,
    origin,
    convergence,
    peer,
)


def make_report(study, results, benchmarks, html, pdf):
    """Write the report of a finished study.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results, benchmarks : str or path
        Folders of its results and of its jobs' benchmarks.
    html, pdf : str or path
        To write, each whole or not at all. Same results, same bytes.

    Raises
    ------
    InputError
        A results file is missing or holds something else.
    """
    document = compose(load_content(study, results, benchmarks))
    write_html(html, document)
    write_pdf(pdf, document)


def compose(content):
    """The report's document from the study's content."""
    return numbered(
        Document(
            title=f"blockshake: {content.study['name']}",
            subtitle=" ".join(content.study["description"].split()),
            sections=tuple(made for section in _SECTIONS if (made := section(content)) is not None),
        )
    )
