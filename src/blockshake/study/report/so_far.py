"""The page of a running study: results of the cases that are done, until the report takes its place."""

from pathlib import Path

from blockshake.pages.blocks import Document, Heading, Section, Text, numbered
from blockshake.pages.words import Words
from blockshake.pages.writing import write_html
from blockshake.study.report.content import cases_so_far
from blockshake.study.report.opening_sections import probability_table
from blockshake.study.report.result_sections import displacements

_OF_STATE = Words(__name__)
_KEY = "so-far"


def write_so_far(study, results, html):
    """Write the page of a study that runs, where no finished report stands.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results, html : str or path
        Folder of its results; the page to write, whole or not at all.

    Returns
    -------
    str
        One line for the terminal; empty where a finished report stands, or no case is done by any model.
    """
    cases = cases_so_far(study, results)
    if not cases or is_finished(html):
        return ""
    done = {name: list(case.responses) for name, case in cases.items()}
    left = len(study["cases"]) * len(study["models"]) - sum(map(len, done.values()))
    stripes = [stripe for case in cases.values() for stripe in case.stripes]
    blocks = [Text(_OF_STATE.state(done, left)), probability_table(stripes)]
    for case in cases.values():
        blocks += [Heading(case.title, f"so-far-{case.name}"), *displacements(case)]
    title = f"blockshake: {study['name']}, so far"
    section = Section("So far", _KEY, tuple(blocks))
    write_html(html, numbered(Document(title, " ".join(study["description"].split()), sections=(section,))))
    return _OF_STATE.line(html, done, left)


def is_finished(html):
    """Whether the file is a finished report, not a page of this module."""
    path = Path(html)
    return path.is_file() and f'id="{_KEY}"' not in path.read_text(encoding="utf-8")
