"""The form of the verdict is that of docs/guide/contracts.md."""

import json

import pytest

from blockshake.diagnosis.verdict.verdict import Estimate, Misfit, Verdict, load_verdict, write_verdict
from blockshake.errors import InputError

CONTRACT = [
    "decision", "causes", "probabilities", "parameters", "location", "misfit", "excluded_above", "next_test", "gain",
    "runs", "caveats", "outside", "odds", "places", "limits", "word", "missing", "row_gain", "next_tests",
    "extension", "histories", "structure", "tests",
]  # fmt: skip


def _named(**changed):
    return Verdict(
        **{
            "decision": "named",
            "causes": ["weak-joint"],
            "probabilities": {"weak-joint": 0.6, "table-pitch": 0.02},
            "parameters": {"weak-joint": {"factor": Estimate(estimate=0.3, lower=0.2, upper=0.4, unit="1")}},
            "location": {"weak-joint": {"joint": ["slab", "block-1"]}},
            "misfit": Misfit(p=0.01, where="slip of slab-block-1 after onset"),
            "runs": 400,
            "word": "probable",
            "missing": ["the effort was quick"],
            **changed,
        }
    )


def test_a_verdict_shows_itself_in_a_line_and_in_a_table():
    verdict = _named()
    assert repr(verdict) == "<Verdict probable (named), weak-joint>"
    for cell in ("weak-joint", "0.6", "factor 0.3 1", "0.2 to 0.4"):
        assert f"<td>{cell}</td>" in verdict._repr_html_()


def test_a_verdict_returns_as_it_was_written(tmp_path):
    path = tmp_path / "verdict.json"
    write_verdict(path, _named())
    assert load_verdict(path) == _named()
    assert [key for key in json.loads(path.read_text()) if key != "version"] == CONTRACT


@pytest.mark.parametrize(
    ("decision", "causes"),
    [
        ("none", ["weak-joint"]),
        ("named", []),
        ("named", ["a", "b"]),
        ("ambiguous", ["a"]),
        ("unknown", ["a"]),
    ],
)
def test_a_decision_that_its_causes_contradict_is_refused(decision, causes):
    with pytest.raises(ValueError, match="number of causes"):
        _named(decision=decision, causes=causes)


@pytest.mark.parametrize("changed", [{"word": "established"}, {"missing": []}, {"word": "validated"}])
def test_a_word_that_its_reasons_contradict_is_refused(changed):
    with pytest.raises(ValueError, match=r"word|missing"):
        _named(**changed)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "expected JSON"),
        ('{"version": 1}', "version: "),
        ('{"version": 2, "decison": "none"}', "decision: missing key"),
    ],
)
def test_another_file_is_one_line(text, message, tmp_path):
    path = tmp_path / "verdict.json"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        load_verdict(path)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_an_interval_holds_its_estimate():
    with pytest.raises(ValueError, match="lower <= estimate <= upper"):
        Estimate(estimate=1.0, lower=2.0, upper=3.0, unit="m")
