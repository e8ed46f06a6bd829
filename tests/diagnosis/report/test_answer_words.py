from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from fake_findings import ECCENTRIC, KINDS, part

from blockshake.diagnosis.answer.decision import Cause, Estimate, Measurement, Part
from blockshake.diagnosis.gain.section import effect_section
from blockshake.diagnosis.report.answer_section import next_tests_table, percent_words
from blockshake.diagnosis.report.statement import not_distinguished, statement, until_then
from blockshake.diagnosis.verdict.grade import NOT_JUDGED
from blockshake.diagnosis.verdict.verdict import Contrast
from blockshake.diagnosis.wording import (
    NO_ERROR,
    chance_words,
    estimate_words,
    named_place,
    place_words,
    times_words,
    when_words,
)
from blockshake.pages.wording import number

# values that the statement has to hold, by kind of decision
STATED = {
    "none": ("No misfit larger than chance", "undamaged blocks explain all forces in 2 tests"),
    "named": ("Probable", "eccentric mass of a block (block-2)", "offset 50 mm (45 to 55) towards +x"),
    "ambiguous": (
        "One of",
        "joint of low friction (joint slab / block-1), factor 41.0 % (36.9 to 45.1)",
        "12.0 mm/s",
    ),
    "combination": ("Probable", "pitch of the table", "11.0 Hz (9.9 to 12.1)", "offset 50 mm (45 to 55)"),
    "unknown": (
        "Something acts, cause unknown",
        "a steady push (block-2 or block-1)",
        "2.20 s of alkion-250",
    ),
}
NOT_DISTINGUISHED = {
    "named": ("The only other cause tried is 160,000 times less probable: an edge that changed",),
    "ambiguous": ("Joint of low friction", "friction that falls with slip rate (4.5 times)", "20 times"),
    "unknown": (
        "The nearest of 2 other causes is",
        "160,000 times",
        "block-2 or block-1",
        "most probably top of block-2",
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_answer_says_what_acts_where_and_how_large(found, kind):
    said = statement(found[kind])
    assert said.startswith(STATED[kind][0])
    assert [part for part in STATED[kind] if part not in said] == []


@pytest.mark.parametrize("kind", NOT_DISTINGUISHED)
def test_what_is_not_told_from_the_answer_follows_it(found, kind):
    (said,) = not_distinguished(found[kind])
    assert [part for part in NOT_DISTINGUISHED[kind] if part not in said] == []


def test_until_then_is_the_largest_upper_limit_of_the_drift_of_all_sealed_tests(found):
    one = found["named"]
    gain = one.gain.sel(response="median_drift")
    factors = {
        str(test): 1.0 + float(at["value_interval"].sel(side="change")[-1] / at["value"].sel(side="without"))
        for test in gain["test"].values
        for at in [gain.sel(test=test)]
    }
    worst = max(factors, key=factors.get)
    said = until_then(one)
    upwards = np.ceil(10.0 * factors[worst]) / 10.0
    assert f"by {number(upwards, 2)}:" in said
    assert f"({worst})" in said
    changes = one.gain.assign(value_interval=-abs(one.gain["value_interval"]))
    assert "use displacements of the nominal model as they are: in no sealed test" in until_then(
        replace(one, gain=changes)
    )
    assert "no factor is known" in until_then(replace(one, gain=None))
    assert until_then(found["unknown"]).endswith("Look at block-2 or block-1 before the next test.")
    assert "nominal model as it is" in until_then(found["none"])
    unjudged = replace(found["none"], verdict=found["none"].verdict.model_copy(update={"word": NOT_JUDGED}))
    assert "no test could be judged" in until_then(unjudged)
    idle = replace(one, verdict=one.verdict.model_copy(update={"extension": ()}))
    assert "predicts the tests to select by no better" in until_then(idle)
    assert effect_section(one) is not None
    assert effect_section(idle) is None


def test_every_part_of_a_combination_has_its_own_sentence(found):
    of_slab, of_joints = not_distinguished(found["combination"])
    assert of_slab.startswith("Rotation of the slab: no other cause")
    assert of_joints.startswith(
        "Joints: the only other cause tried is 160,000 times less probable: an edge that changed"
    )


def test_a_height_that_is_not_told_is_not_called_a_place():
    cause = {**ECCENTRIC, "name": "rope", "place": {"body": "block-3", "height": 0.42}}
    cause |= {"places": ["block-3@0.42", "block-3@0"], "parameters": {}}
    one = Part.model_validate(part("joints", cause))
    found = SimpleNamespace(decision=SimpleNamespace(parts=[one]), bodies=("block-3",))
    assert not_distinguished(found)[0].endswith(
        "The height is not known; the most probable is top of block-3."
    )


@pytest.mark.parametrize(
    ("name", "values", "unit", "words"),
    [
        ("offset", (-0.0947, -0.105, -0.0849), "m", "95 mm (85 to 105) towards -x"),
        ("force", (2e3, -1e3, 5e3), "N", "2.0 kN (-1.0 to 5.0)"),  # to either side
        ("coefficient", (-5e-4, -6e-4, -4e-4), "rad s2/m", "-0.50 mrad per m/s² (-0.60 to -0.40)"),
        ("factor", (0.153, 0.0, 0.384), "1", "15 % (0 to 38)"),
    ],
)
def test_sizes_have_units_and_sides(name, values, unit, words):
    middle, lower, upper = values
    assert estimate_words(name, Estimate(estimate=middle, lower=lower, upper=upper, unit=unit)) == words


def test_places_in_words():
    assert place_words({"joint": ["slab", "block-1"]}) == "joint slab / block-1"
    assert place_words({"body": "block-1", "height": 0.0}) == "middle of block-1"
    assert place_words({}) == ""
    assert named_place("block-1@0.42", ()) == "top of block-1"
    assert named_place("slab-block-1", ("block-1",)) == "joint slab-block-1"


@pytest.mark.parametrize(
    ("when", "words"),
    [
        ({"blows": {"t2": {"time": 3.52, "width": 0.08}}}, "at 3.52 s of t2"),
        (
            {"test": "t3", "start": 1.665, "lasts": True, "edge": 1},
            "from 1.67 s of t3 on and in the tests after it",
        ),
        ({"test": "t3", "start": 1.5, "lasts": False}, "from 1.50 s of t3 on"),
        ({"test": "t4", "side": 1, "gap": 0.01}, "in t4 alone"),
        ({"starts": {"t1": -0.02}}, "from 0.00 s of t1 on"),
        (
            {"starts": {"t1": 3.0, "t2": 2.0}, "before": ["t1"]},
            "from 3.00 s or earlier of t1 and 2.00 s of t2 on",
        ),
        ({"grip": 0.2}, ""),
    ],
)
def test_when_a_form_acts(when, words):
    assert when_words(when) == words


def test_chances_and_odds_are_not_printed_with_more_digits_than_they_have():
    assert chance_words(0.0123) == "p = 0.012"
    assert chance_words(1e-30) == "less than 1 in a million"
    assert times_words(0.9) == "2.5 times"
    assert times_words(9.675) == "16,000 times"
    assert times_words(40.0) == "more than a million times"


def test_a_gain_without_anything_to_gain_is_called_so():
    assert percent_words(Contrast(estimate=0.0, lower=-1.0, upper=1.0)) == NO_ERROR
    assert percent_words(Contrast(estimate=0.5, lower=-0.1, upper=0.7)) == "50 % (-10 to 70 %)"


def test_cause_has_the_title_of_its_form():
    assert Cause.model_validate({**ECCENTRIC, "name": "blow"}).title == "a blow"


def test_measurements_that_split_a_set_are_a_table():
    jack = Measurement(
        between=("weak-joint", "rate-weakening-friction"),
        kind="jack",
        test="push block-1 with a jack",
        share=0.9,
    )
    (table,) = next_tests_table(SimpleNamespace(next_tests=(jack,)))
    words = "joint of low friction or friction that falls with slip rate"
    assert table.rows == (("Push block-1 with a jack", words, "90 %"),)
    assert next_tests_table(SimpleNamespace(next_tests=())) == []
