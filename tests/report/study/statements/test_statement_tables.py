import re
from dataclasses import replace

from page import CLAIMS

from blockshake.files import HOME
from blockshake.report.study.statements.section import (
    DEPARTURES_HEADER,
    HEADER,
    count_words,
    departures,
    judge_statements,
    statements,
)
from blockshake.report.study.statements.statement import Verdict
from blockshake.report.study.statements.table import STATEMENTS


def test_every_statement_has_a_place_a_verdict_and_a_command(content):
    found = judge_statements(content)
    rows = [row for rows in found.values() for row in rows]
    assert len({row[1] for row in rows}) == len(rows)
    for place, claim, verdict, words, command in rows:
        assert place
        assert claim.endswith(".")
        assert verdict in list(Verdict)
        assert words.endswith(".")
        assert "nan" not in words.split()
        assert command.startswith(("snakemake -c2 results/fake/", "blockshake "))
        assert not [claimed for claimed in CLAIMS if claimed in f"{claim} {words}".lower()]
    given = [row[2] for row in rows]
    assert f"Of {len(rows)} statements: {given.count('met')} met," in count_words(found)


def test_every_figure_table_and_equation_of_the_paper_stands_in_the_list():
    places = " ".join(one.place for rows in STATEMENTS.values() for one in rows)
    places += " 12 13" * ("Figs. 11 to 14" in places)
    for equation in (1, 2, 3, 4, 5, 6, 7, 8):
        assert f"({equation})" in places
    for figure in (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14):
        assert re.search(rf"\b{figure}\b", places), figure
    for table in (1, 2):
        assert f"Table {table}" in places


def test_the_section_has_the_findings_and_the_departures(content):
    section = statements(content)
    tables = [block for block in section.blocks if block.kind == "table"]
    assert [table.header for table in tables] == [HEADER] * len(STATEMENTS) + [DEPARTURES_HEADER]
    for table in tables:
        assert len(table.widths) == len(table.header)


def test_a_study_of_one_model_and_no_test_judges_what_it_can(content):
    content = replace(content, calibration=None)
    content.study["models"].pop("nscd-rigid")
    for name, case in content.cases.items():
        del case.responses["nscd-rigid"]
        content.cases[name] = replace(case, measured=None, base=None, synthetic=False)
    rows = [row for rows in judge_statements(content).values() for row in rows]
    unjudged = [row for row in rows if row[2] == Verdict.UNJUDGED]
    assert {row[1] for row in unjudged} >= {
        "A mean of 0.75 is the best.", "The two models behave alike.", "Both models resemble the tests closely.",
    }  # fmt: skip
    assert len(unjudged) < len(rows)


def test_departures_name_their_reasons():
    rows = departures()
    assert {row[0] for row in rows} == {
        "LS-DEM", "Stiffness", "Structures", "NSCD", "Input", "Statistics", "Defaults",
    }  # fmt: skip
    here = {row[1]: row[2] for row in rows}
    assert "a beam 6.09 times" in here["Nothing is said of lying blocks and beams."]
    assert "2 and 48.7 times" in here["Nothing is said of lying blocks and beams."]
    assert "378 mm from its middle" in here["Nodes cover the surface, chamfer included."]
    assert "21.6 GN" in here["Calibrated stiffness everywhere."]
    if (HOME / "docs").is_dir():
        for row in rows:
            assert (HOME / row[3]).exists(), row[3]


def test_structures_of_a_user_do_not_bear_on_the_paper(content):
    own = content.cases.pop("configuration-4")
    alone = judge_statements(replace(content, calibration=None))  # which the user's tests would take part in
    settings = {**own.settings, "structure": "own/wall.yaml"}
    content.cases["wall"] = replace(own, name="wall", settings=settings)
    assert judge_statements(content) == alone
    del content.cases["configuration-1"]
    assert judge_statements(content) == {}
