"""Filters of sentences, and macros that are filled in."""

import jinja2
import pytest

from blockshake.pages.wording import MISSING
from blockshake.pages.words import Words, either, length, span, whole_percent
from blockshake.study.report import answer


@pytest.mark.parametrize(
    ("metres", "words"),
    [
        (0.0, "0"),
        (5e-10, "0"),
        (-4e-5, "0"),
        (6e-5, "0.1"),
        (0.0094, "9.4"),
        (0.00996, "10"),
        (1.2345, "1234"),
    ],
)
def test_a_length_has_the_digits_that_it_bears(metres, words):
    assert length(metres) == words
    assert length(float("nan")) == MISSING


def test_spans_of_what_prints_alike_are_one_number():
    assert (span([0.0301, 0.0299]), span([0.02, 0.01])) == ("30", "10 to 20")
    assert span([0.041, 0.049], whole_percent) == "4 to 5"


def test_plurals_follow_the_count():
    assert [either(count, "run is", "runs are") for count in (0, 1, 2)] == ["runs are", "run is", "runs are"]


def test_a_macro_is_one_line_and_a_list_a_line_an_item():
    words = Words(answer.__name__)
    assert words.by_level([("at 3", "1.0"), ("at 6", "2")], "mm") == "1.0 mm at 3, 2 mm at 6"
    assert words.items("measured", []) == ()


def test_a_fact_that_nobody_gives_is_an_error():
    with pytest.raises(jinja2.UndefinedError):
        Words(answer.__name__).displacement(case={}, one=None)
