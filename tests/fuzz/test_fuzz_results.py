"""Results in JSON with mutations - decisions, verdicts, parity, track record - are read or refused."""

import json

import numpy as np
import pytest
from contract import read_or_refused, scratch
from hypothesis import given
from hypothesis import strategies as st
from made_up_decision import made_up_decision
from mutations import FEW, MANY, mutated_bytes, mutated_mappings, mutated_texts, mutations, nested

from blockshake.diagnosis.answer.decision import check_frozen, load_decision
from blockshake.diagnosis.verdict.track_record import load_track_record
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.errors import InputError
from blockshake.files import HOME, load_json
from blockshake.parity.finding import Finding
from blockshake.parity.parity import load_parity

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

_ESTIMATE = {"estimate": 0.3, "lower": 0.2, "upper": 0.4, "unit": "1"}
_CONTRAST = {"estimate": 0.8, "lower": 0.7, "upper": 0.9}
_GAIN = {"recalibrated": _CONTRAST, "nominal": _CONTRAST, "discrepancy": _CONTRAST, "placebo": None}
VERDICT = {
    "version": 4, "decision": "named", "causes": ["weak-joint"], "probabilities": {"weak-joint": 0.6,
    "table-pitch": 0.02},
    "parameters": {"weak-joint": {"factor": _ESTIMATE}}, "location": {"weak-joint": {"joint": ["slab", "block-1"]}},
    "misfit": {"p": 0.01, "where": "slip"}, "excluded_above": {"table-pitch": 1e-4}, "next_test": None,
    "gain": _GAIN, "row_gain": _GAIN, "runs": 400, "caveats": ["few"], "odds": {"weak-joint": 0.0},
    "places": {"weak-joint": ["slab-block-1"]}, "limits": {"weak-joint": {"slab-block-1": 0.6}},
    "outside": {"form": "push", "title": "a push", "place": {"body": "block-1", "height": 0.0}, "places": ["block-1"],
    "size": {"force": _ESTIMATE}, "starts": {"t1": 2.0}},
    "word": "probable", "missing": ["two causes act together"],
}  # fmt: skip
DECISION = made_up_decision("named", ("weak-joint",)).model_dump(mode="json")
_FINDING = Finding("sensor-gain", ("a-x",), "gain", np.array([0.1]), np.array([[1e-4]]), 0.01, ("t1",))
PARITY = {
    "findings": [_FINDING.as_json() | {"where": ["a-x"], "tests": ["t1"]}],
    "markers": {"m": {"noise": 1e-4, "misfit": None}}, "clock": {"t1": {"lag": 0.0, "lag_error": 1e-3}},
    "channels": {"a-x": {"gain": 0.1, "gain_error": 0.01}}, "looked_at": 12,
    "falls": {"t1": {"body": "a", "time": 2.5}},
    "gaps": {"t1": ["0 m throughout while others change, taken as gaps: a.z"]},
}  # fmt: skip
FROZEN = {"digest": "0123456789ab", "tests": ["t1"]}


def frozen(path):
    """The comparison of a frozen digest with a file, whose refusal is the right answer."""
    check_frozen(path, path)


READERS = {
    "verdict": (VERDICT, load_verdict),
    "decision": (DECISION, load_decision),
    "parity": (PARITY, load_parity),
    "frozen": (FROZEN, frozen),
    "track record": (
        load_json(HOME / "data" / "track-record" / "hidden-effects.json"), load_track_record,
    ),
}  # fmt: skip
# JSON has no dates and no keys but texts
ODD = ("", "x", "a\nb", "<script>", None, True, 0, -1, 1e308, float("nan"), float("inf"), 10**400, [], {}, [[]],
       {"a": 1}, nested(40), nested(900), [0] * 2000, {f"k{n}": n for n in range(500)})  # fmt: skip


def damaged(name):
    """Mutations of a result's values, of its text, and of its bytes."""
    good = READERS[name][0]
    whole = json.dumps(good)
    by_value = st.just(good) if name == "track record" else mutated_mappings(good, ODD)
    return st.one_of(
        by_value.map(lambda value: _json(value).encode("utf-8", "surrogatepass")),
        mutated_texts(whole).map(lambda text: text.encode("utf-8", "surrogatepass")),
        mutated_bytes(whole.encode()),
    )


def _json(value):
    try:
        return json.dumps(value)
    except TypeError:  # keys of several kinds
        return json.dumps(value, skipkeys=True)
    except RecursionError:  # lists in lists, deeper than the writer goes
        return "[" * 100_000


def read(name, content):
    """Whether a result with this content is read."""
    with scratch() as folder:
        path = f"{folder}/r.json"
        with open(path, "wb") as file:
            file.write(content)
        return read_or_refused(lambda: READERS[name][1](path), folder)


@pytest.mark.parametrize("name", [name for name in READERS if name != "frozen"])
def test_good_results_are_read(name):
    assert read(name, json.dumps(READERS[name][0]).encode())


def test_a_frozen_file_without_a_digest_is_refused(tmp_path):
    (tmp_path / "frozen.json").write_text("[]")
    with pytest.raises(InputError, match=r"frozen\.json"):
        check_frozen(tmp_path / "frozen.json", tmp_path / "frozen.json")


def test_lists_in_lists_are_refused(tmp_path):
    (tmp_path / "v.json").write_text("[" * 100_000)
    with pytest.raises(InputError, match="expected JSON"):
        load_verdict(tmp_path / "v.json")


@pytest.mark.parametrize("name", READERS)
@mutations(FEW)
@given(st.data())
def test_mutated_results(name, data):
    read(name, data.draw(damaged(name)))


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
@mutations(MANY)
@given(st.data())
def test_many_mutated_results(name, data):
    read(name, data.draw(damaged(name)))
