"""Sizes from which a cause would be seen: nine of ten noises, by the needs of the decision."""

import numpy as np
import pytest

from blockshake.diagnosis.answer.limits import _by_place, from_null, largest, usual_column
from blockshake.diagnosis.answer.thresholds import by_odds
from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.likelihood import Likelihood, from_rows
from blockshake.effects.effect import DesignMatrix

DRAWS, ROWS, SCALE = 400, 60, 0.06
NAME = "eccentricity"


@pytest.fixture(scope="module")
def made():
    """Noise of known covariance, one nuisance, and the column of a cause."""
    generator = np.random.default_rng(4)
    time = np.arange(ROWS) * 0.02
    covariance = np.exp(-np.abs(time[:, None] - time) / 0.03) * 0.5 + 0.5 * np.eye(ROWS)
    column, nuisance = generator.normal(0.0, 100.0, (2, ROWS))
    likelihood = from_rows([covariance], [np.zeros(ROWS)], [[0.003 * nuisance]])
    return likelihood, [[DesignMatrix({}, column[:, None], (SCALE,), False)]]


def _found(likelihood, variants, size, generator):
    """Share of noises in which the cause gains what it needs, drawn by the model itself."""
    true = size * likelihood.whiten([variants[0][0].rows])[:, 0]
    hits = 0
    for _ in range(DRAWS):
        value = true + generator.standard_normal(ROWS) + likelihood.nuisances @ generator.standard_normal(1)
        drawn = Likelihood(likelihood.roots, value, likelihood.nuisances, 0.0)
        hits += best_of(drawn, NAME, "block-1", variants).gain > by_odds(NAME)
    return hits / DRAWS


def test_nine_of_ten_of_the_limit_are_seen_and_few_of_half_of_it(made):
    likelihood, variants = made
    limit = _by_place(NAME, likelihood, {"block-1": variants}, by_odds(NAME))["block-1"]
    generator = np.random.default_rng(5)
    deviation = np.sqrt(0.9 * 0.1 / DRAWS)
    # the noise that a fitted amplitude takes up adds half a nat to the gain in the mean
    assert 0.9 - 3.0 * deviation < _found(likelihood, variants, limit, generator) < 0.97
    assert _found(likelihood, variants, 0.5 * limit, generator) < 0.1


def test_of_alike_variants_the_one_that_tells_least_is_usual(made):
    likelihood, ((columns,),) = made
    strong, weak = (
        columns._replace(values={"frequency": 15.0, "damping": 0.05}),
        columns._replace(rows=0.2 * columns.rows, values={"frequency": 15.0, "damping": 1.0}),
    )
    far = columns._replace(rows=0.01 * columns.rows, values={"frequency": 5.0, "damping": 1.0})
    unit, precision = usual_column("table-pitch", [[strong], [far], [weak]], likelihood)
    np.testing.assert_allclose(unit, likelihood.whiten([weak.rows])[:, 0])
    assert precision == pytest.approx(float(likelihood.normal_equations(unit[:, None])[1][0, 0]))


def test_sizes_count_from_the_null_value_towards_the_visible_one():
    assert from_null("weak-joint", 0.25) == pytest.approx(0.75)
    assert largest("weak-joint") == pytest.approx(0.9)
    assert from_null("eccentricity", 0.02) == pytest.approx(0.02)
