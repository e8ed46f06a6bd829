"""The report of the made-up study, as blocks, as files and as its reader sees it."""

import copy
import shutil
from pathlib import Path

import pytest
from page import Page

from blockshake.report.study.content import load_content
from blockshake.report.study.report import compose, make_report


@pytest.fixture(scope="session")
def report(fake, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    paths = folder / "fake.html", folder / "fake.pdf", folder / "the-paper.json"
    make_report(fake.study, fake.results, fake.logs, *paths)
    return paths


@pytest.fixture(scope="session")
def document(fake):
    """Composed a second time from the same files."""
    return compose(load_content(fake.study, fake.results, fake.logs))


@pytest.fixture
def copied(fake, tmp_path):
    """The made-up study with results of its own, to be changed."""
    own = copy.copy(fake)
    own.results = Path(shutil.copytree(fake.results, tmp_path / "results"))
    return own


@pytest.fixture(scope="session")
def page(report):
    parsed = Page()
    parsed.feed(report[0].read_text(encoding="utf-8"))
    parsed.close()
    return parsed


@pytest.fixture(scope="session")
def text(page):
    return " ".join(" ".join(page.words).split())
