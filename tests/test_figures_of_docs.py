"""Figures in docs/ that a command makes: each has its maker, and the cheap ones are those of today."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "bench"))
    import figures_of_docs

    yield figures_of_docs
    sys.modules.pop("figures_of_docs")


def test_every_figure_has_its_maker_and_its_page(figures):
    named = [name for page in sorted((ROOT / "docs").rglob("*.md")) for name in figures.blocks(page)]
    assert sorted(named) == sorted(figures.MAKERS)


def test_a_page_holds_the_figures_of_today(figures):
    page = ROOT / "docs" / "friction-calibration.md"
    assert figures.blocks(page)["slenderness"] == figures.slenderness()


def test_only_the_figures_are_written(figures, monkeypatch, tmp_path):
    (tmp_path / "page.md").write_text(
        "Before.\n\n" + figures.BLOCK.format("slenderness", "old") + "\n\nAfter.\n"
    )
    monkeypatch.setattr(figures, "DOCS", tmp_path)
    figures.main([])
    expected = figures.BLOCK.format("slenderness", figures.slenderness())
    assert (tmp_path / "page.md").read_text() == f"Before.\n\n{expected}\n\nAfter.\n"
