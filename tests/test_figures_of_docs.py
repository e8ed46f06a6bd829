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
    page = ROOT / "docs" / "guide" / "calibration.md"
    assert figures.blocks(page)["slenderness"] == figures.slenderness()


def test_findings_on_the_paper_are_on_the_statements_of_today(figures):
    import the_paper

    text = figures.blocks(ROOT / "docs" / "results" / "the-paper.md")["statements"]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    rows = [row for row in rows if row[0] not in (the_paper.HEADER[0], "---")]
    stated = [one[:2] for one in the_paper.STATEMENTS]
    assert [(row[0], row[1]) for row in rows] == stated
    assert {row[2] for row in rows} == set(the_paper.VERDICTS.values())
    assert the_paper.count_words(rows) in " ".join(text.split())


def test_findings_stay_where_no_study_was_run(figures, monkeypatch, tmp_path, capsys):
    (tmp_path / "page.md").write_text(figures.BLOCK.format("statements", "old"))
    monkeypatch.setattr(figures, "DOCS", tmp_path)
    monkeypatch.chdir(tmp_path)
    figures.main([])
    assert (tmp_path / "page.md").read_text() == figures.BLOCK.format("statements", "old")
    assert "statements stays" in capsys.readouterr().out


def test_only_the_figures_are_written(figures, monkeypatch, tmp_path):
    (tmp_path / "page.md").write_text(
        "Before.\n\n" + figures.BLOCK.format("slenderness", "old") + "\n\nAfter.\n"
    )
    monkeypatch.setattr(figures, "DOCS", tmp_path)
    figures.main([])
    expected = figures.BLOCK.format("slenderness", figures.slenderness())
    assert (tmp_path / "page.md").read_text() == f"Before.\n\n{expected}\n\nAfter.\n"
