"""Thresholds of evidence: odds by definition, and the rate of false alarms on made-up runs."""

import numpy as np
import pytest

from blockshake.diagnosis.answer.thresholds import (
    FREE_FORCE,
    RATE,
    Thresholds,
    by_odds,
    score_of,
    thresholds_of,
)
from blockshake.diagnosis.outside.registry import FORMS

CAUSES = [f"cause-{number}" for number in range(15)]
CAMPAIGNS, FRESH = 300, 5


def clean(generator):
    """A right model: the chance of an evidence falls as exp(-x)."""
    return {name: generator.exponential() - 2.0 for name in CAUSES}


def loop(generator):
    """A structure whose own runs always support one cause."""
    return clean(generator) | {CAUSES[0]: generator.normal(30.0, 10.0)}


def heavy(generator):
    """Evidence with a tail that is heavier than an exponential one."""
    return clean(generator) | {CAUSES[0]: generator.lognormal(1.0, 1.0)}


@pytest.mark.parametrize("draw", [clean, loop, heavy])
@pytest.mark.parametrize("runs", [4, 20])
def test_fresh_campaigns_exceed_the_thresholds_at_most_at_the_rate(draw, runs):
    generator, exceeded = np.random.default_rng(runs), 0
    for _ in range(CAMPAIGNS):
        thresholds = thresholds_of([draw(generator) for _ in range(runs)])
        for _ in range(FRESH):
            exceeded += any(gain > thresholds.by_chance[name] for name, gain in draw(generator).items())
    assert exceeded / (CAMPAIGNS * FRESH) <= RATE


def test_a_cause_that_the_runs_always_speak_for_needs_more_and_no_other_does():
    generator = np.random.default_rng(1)
    thresholds = thresholds_of([loop(generator) for _ in range(20)])
    assert thresholds.of(CAUSES[0]) > 60.0
    assert max(thresholds.of(name) for name in CAUSES[1:]) < 10.0


def test_without_runs_the_posterior_odds_of_twenty_decide():
    for name in ("eccentricity", next(iter(FORMS)), FREE_FORCE):
        assert score_of(name, by_odds(name)) == pytest.approx(np.log(20.0))
        assert Thresholds().of(name) == thresholds_of([{}, {}]).of(name) == by_odds(name)


def test_quiet_runs_leave_the_odds_and_few_runs_cost_more_than_many():
    quiet = [dict.fromkeys(CAUSES, -1.0)] * 20
    assert thresholds_of(quiet).of("eccentricity") == by_odds("eccentricity")
    one = {"eccentricity": 8.0}
    few, many = (thresholds_of([one] + [{"eccentricity": -1.0}] * (count - 1)) for count in (2, 20))
    assert few.of("eccentricity") > many.of("eccentricity") > by_odds("eccentricity")
