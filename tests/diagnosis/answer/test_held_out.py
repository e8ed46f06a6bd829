"""The chosen cause on the tests to select by alone: borne out or not, at a level that holds."""

from types import SimpleNamespace

import numpy as np
import pytest
from simulated_tests import cause_of, seen_tests

from blockshake.diagnosis.answer.answer import Alternative, Group
from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.answer.held_out import held_out_rows
from blockshake.diagnosis.evidence.likelihood import from_rows

MOTIONS = {"first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0), "third": ("alkion", 3.0)}
ECCENTRICITY = cause_of("eccentricity", {"body": "block-2"}, {"offset": 0.06}, {})
TESTS, ROWS, TRIED = ("fit", "select"), 30, 12


@pytest.fixture(scope="module")
def eccentric():
    """Tests of two blocks, the upper one with an eccentric mass centre."""
    return seen_tests("two-blocks", MOTIONS, ECCENTRICITY)


def test_a_cause_in_every_test_holds(eccentric):
    (part,) = decide(eccentric, select=("third",)).decision.parts
    assert part.held_out.tests == ("third",)
    assert part.held_out.tells
    assert part.held_out.holds


def test_a_cause_that_the_test_to_select_by_lacks_does_not_hold(eccentric):
    *fitted, _ = eccentric
    *_, third = seen_tests("two-blocks", MOTIONS)
    parts = decide([*fitted, third], select=("third",)).decision.parts
    assert parts
    assert not any(part.held_out.holds for part in parts)


def test_without_a_test_to_select_by_nothing_is_held_out(eccentric):
    assert decide(eccentric).decision.parts[0].held_out is None


def test_the_level_holds_although_all_tests_choose_the_cause():
    """Of 2,000 campaigns of white noise, at most 5 % and three standard errors bear the chosen cause out."""
    rng = np.random.default_rng(7)
    columns = rng.normal(size=(TRIED, 2 * ROWS))
    held = [_chosen(rng.normal(size=2 * ROWS), columns).p <= 0.05 for _ in range(2000)]
    assert 0 < sum(held) <= 2000 * (0.05 + 3.0 * np.sqrt(0.05 * 0.95 / 2000))


def _chosen(values, columns):
    """`HeldOut` of the column with the largest evidence in noise of deviation 1."""
    evidence = _Evidence(values, columns, (0, 1))
    best = max(evidence.keys, key=evidence.gain)
    group = Group((Alternative(*best, evidence.gain(best), 0.0, (best[1],)),), {}, {})
    return held_out_rows(evidence, group, ("select",))


class _Evidence:
    """Evidence of columns of known amplitude scale 1, by tests of `ROWS` rows of white noise."""

    def __init__(self, values, columns, numbers):
        self.whole, self.numbers = (values, columns), numbers
        cut = [slice(n * ROWS, (n + 1) * ROWS) for n in numbers]
        self.likelihood = from_rows([np.eye(ROWS)] * len(cut), [values[rows] for rows in cut], [])
        self.columns = [[column[rows] for rows in cut] for column in columns]
        self.tests = [SimpleNamespace(seen=SimpleNamespace(name=TESTS[n])) for n in numbers]
        self.keys = [("column", str(number)) for number in range(len(columns))]

    def gain(self, key):
        whitened = self.likelihood.whiten([rows[:, None] for rows in self.columns[int(key[1])]])
        return self.likelihood.amplitudes(whitened, np.ones(1)).gain

    def of_tests(self, numbers, _):
        return _Evidence(*self.whole, numbers)

    def most_probable(self, _):
        return self

    def best(self, key):
        return SimpleNamespace(rows=self.columns[int(key[1])])
