from dataclasses import replace

from page import CLAIMS

from blockshake.study.statements.section import (
    count_words,
    judge_statements,
)
from blockshake.study.statements.statement import PaperVerdict


def test_every_statement_has_a_place_and_a_verdict(content):
    found = judge_statements(content)
    rows = [row for rows in found.values() for row in rows]
    assert len({row[1] for row in rows}) == len(rows)
    for place, claim, verdict, words in rows:
        assert place
        assert claim.endswith(".")
        assert verdict in list(PaperVerdict)
        assert words.endswith(".")
        assert "nan" not in words.split()
        assert not [claimed for claimed in CLAIMS if claimed in f"{claim} {words}".lower()]
    given = [row[2] for row in rows]
    assert f"Of {len(rows)} statements: {given.count('met')} met," in count_words(found)


def test_a_study_of_one_model_and_no_test_judges_what_it_can(content):
    content = replace(content, calibration=None)
    content.study["models"].pop("nscd-rigid")
    for name, case in content.cases.items():
        del case.responses["nscd-rigid"]
        content.cases[name] = replace(case, measured=None, base=None, synthetic=False)
    rows = [row for rows in judge_statements(content).values() for row in rows]
    unjudged = [row for row in rows if row[2] == PaperVerdict.UNJUDGED]
    assert {row[1] for row in unjudged} >= {
        "A mean of 0.75 is the best.", "The two models behave alike.", "Both models resemble the tests closely.",
    }  # fmt: skip
    assert len(unjudged) < len(rows)
    words = {row[1]: row[3] for row in rows}
    assert words["The two models behave alike."] == "This study has no NSCD rigid."
    assert words["Both models resemble the tests closely."] == "This study has no measured test."


def test_structures_of_a_user_do_not_bear_on_the_paper(content):
    own = content.cases.pop("configuration-4")
    alone = judge_statements(replace(content, calibration=None))  # which the user's tests would take part in
    settings = {**own.settings, "structure": "own/wall.yaml"}
    content.cases["wall"] = replace(own, name="wall", settings=settings)
    assert judge_statements(content) == alone
    del content.cases["configuration-1"]
    assert judge_statements(content) == {}
