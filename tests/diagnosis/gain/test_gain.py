"""Gain in worlds whose truth is known: the extended model, the nominal one, or another effect."""

import numpy as np
import pytest

from blockshake.diagnosis.gain import gain
from blockshake.diagnosis.gain.cell_scores import cells_of, distances
from blockshake.diagnosis.gain.gain import gain_of_verdict, gain_on
from blockshake.diagnosis.gain.sealed_prediction import SealedTest
from blockshake.diagnosis.misfit.curve_scores import members_crps
from blockshake.study.ensembles.scores import crps

MODELS = ("ls-dem", "nscd-rigid")
FEATURES = [f"{part}.{number}" for part in ("joint1", "joint2", "base", "top") for number in range(12)]
COUNT = 30


class World:
    """Features with common factors and noise; effects are directions; the models differ a little."""

    def __init__(self, seed, n_tests):
        self.generator = np.random.default_rng(seed)
        self.n_tests = n_tests
        self.mixing = self.generator.normal(0.0, 0.3, (n_tests, 5, len(FEATURES)))
        self.bias = {model: self.generator.normal(0.0, 0.2, (n_tests, len(FEATURES))) for model in MODELS}
        self.right, self.wrong = self.generator.normal(0.0, 1.0, (2, n_tests, len(FEATURES)))

    def draws(self, count, model, added=0.0, spread=1.0):
        """Features of some draws, (n_tests, count, n_features): the same factors in all tests."""
        factors = self.generator.normal(size=(count, 5))
        noise = self.generator.normal(0.0, 0.7, (self.n_tests, count, len(FEATURES)))
        plain = np.einsum("cf,tfn->tcn", factors, self.mixing) + noise
        return self.bias[model][:, None] + spread * plain + np.reshape(added, (self.n_tests, 1, -1))

    def sealed(self, truth, extended, model="ls-dem"):
        nothing = np.zeros_like(self.right)
        measured = self.draws(1, model, truth)[:, 0]
        ensembles = {
            "nominal": {name: self.draws(COUNT, name, nothing) for name in MODELS},
            "recalibrated": {name: self.draws(COUNT, name, 0.1 * truth) for name in MODELS},
            "extended": {name: self.draws(COUNT, name, extended) for name in MODELS},
            "discrepancy": {name: self.draws(COUNT, name, 0.3 * truth, 1.5) for name in MODELS},
        }
        return [
            SealedTest(
                f"sealed-{test}", FEATURES, measured[test],
                {kind: {name: runs[test] for name, runs in own.items()} for kind, own in ensembles.items()},
            )
            for test in range(self.n_tests)
        ]  # fmt: skip


def unit(test):
    """Spread of each feature over nominal and extended members."""
    return np.concatenate(
        [runs for kind in ("nominal", "extended") for runs in test.members[kind].values()]
    ).std(axis=0, ddof=1)


def pooled(test, kind):
    return np.concatenate(list(test.members[kind].values())) / unit(test)


@pytest.fixture(autouse=True)
def fewer_replicates(monkeypatch):
    monkeypatch.setattr(gain, "_REPLICATES", 200)


def test_score_is_the_ranked_probability_score_and_the_floor_its_leave_one_out_mean():
    tests = World(1, 2).sealed(truth=np.ones((2, 48)), extended=np.ones((2, 48)))
    result = gain_on(tests)
    for kind in result["kind"].values:
        expected = [crps(pooled(test, kind), test.measured / unit(test)).mean() for test in tests]
        np.testing.assert_allclose(result["score_of_test"].sel(kind=kind), expected, rtol=1e-12)
        assert float(result["score"].sel(kind=kind)) == pytest.approx(np.mean(expected), rel=1e-12)
    own = np.mean([members_crps(pooled(test, "extended")).mean(axis=1) for test in tests], axis=0)
    assert float(result["floor"]) == pytest.approx(own.mean(), rel=1e-12)
    assert float(result["highest"]) == pytest.approx(np.quantile(own, 0.95), rel=1e-12)
    top = np.array([name.startswith("top") for name in FEATURES])
    expected = np.mean([crps(pooled(test, "nominal"), test.measured / unit(test))[top] for test in tests])
    assert float(result["score_of_family"].sel(kind="nominal", family="top")) == pytest.approx(
        expected, rel=1e-12
    )


def test_members_drawn_twice_are_no_pair():
    """A bootstrap's score is on average the ensemble's own, not less for the distance 0 of a member to itself."""
    tests = World(2, 1).sealed(truth=np.ones((1, 48)), extended=np.ones((1, 48)))
    own = distances(tests, cells_of(tests), "extended")
    drawn = np.array([own.scores(own.drawn_weights(MODELS, seed))[1] for seed in range(400)])
    error = 4.0 * drawn.std(axis=0) / np.sqrt(400)
    assert (np.abs(drawn.mean(axis=0) - own.scores(own.even_weights(MODELS))[1]) < error + 1e-4).all()


@pytest.mark.parametrize("n_tests", [1, 3])
def test_the_right_effect_gains_nearly_all(n_tests):
    gains, inside, of_wrong = [], [], []
    for seed in range(8):
        model = MODELS[seed % 2]
        world = World([seed, 7], n_tests)
        result = gain_on(world.sealed(truth=2.0 * world.right, extended=2.0 * world.right, model=model))
        gains.append(float(result["gain"].sel(rival="recalibrated")))
        contrast = gain_of_verdict(result, 0).gain.recalibrated
        inside.append(contrast.upper == 1.0)
        assert float(result["fall_lower"].sel(rival="recalibrated")) > 0.0
        assert bool(result["confirmed"])
        world = World([seed, 7], n_tests)
        other = gain_on(world.sealed(truth=2.0 * world.right, extended=2.0 * world.wrong, model=model))
        of_wrong.append(float(other["gain"].sel(rival="recalibrated")))
    # a record's own chance moves the score; the mean of eight gains is within 4 standard errors of 1
    assert np.mean(gains) == pytest.approx(1.0, abs=4.0 * np.std(gains) / np.sqrt(8))
    assert np.std(gains) < 0.3
    # the interval of 90 % reaches 1, with 4 standard errors of eight
    assert np.mean(inside) > 0.9 - 4.0 * np.sqrt(0.9 * 0.1 / 8)
    assert (np.array(of_wrong) < np.array(gains) - 0.5).all()
    assert max(of_wrong) < 0.0


def test_without_an_effect_nothing_is_there_to_gain():
    gains, verdicts = [], []
    for seed in range(24):
        world = World([seed, 8], 2)
        nothing = np.zeros_like(world.right)
        result = gain_on(world.sealed(truth=nothing, extended=0.3 * world.wrong, model=MODELS[seed % 2]))
        gains.append(float(result["gain"].sel(rival="recalibrated")))
        verdicts.append(gain_of_verdict(result, 0).gain.recalibrated.estimate)
    defined = np.isfinite(gains)
    # 1 in 20 records scores above 95 % of its own like: with 4 standard errors of 24
    assert defined.mean() < 0.05 + 4.0 * np.sqrt(0.05 * 0.95 / 24)
    assert all(gain < 0.3 for gain in np.array(gains)[defined])
    assert np.median(verdicts) == 0.0


def test_equal_ensembles_have_equal_scores_and_no_fall():
    world = World(5, 2)
    tests = world.sealed(truth=world.right, extended=world.right)
    same = [
        SealedTest(
            test.name, FEATURES, test.measured, {**test.members, "extended": test.members["recalibrated"]}
        )
        for test in tests
    ]
    result = gain_on(same)
    assert float(result["fall"].sel(rival="recalibrated")) == 0.0
    assert float(result["fall_lower"].sel(rival="recalibrated")) == 0.0
    assert float(result["fall_upper"].sel(rival="recalibrated")) == 0.0
    assert not bool(result["confirmed"])
    assert not result["worse"].any()


def test_a_family_that_the_extension_spoils_is_told():
    world = World(6, 3)
    spoilt = 2.0 * world.right
    spoilt[:, 24:36] += 3.0  # the base
    result = gain_on(world.sealed(truth=2.0 * world.right, extended=spoilt))
    assert result["family"].values[result["worse"].values].tolist() == ["base"]
    assert float(result["fall_of_family"].sel(family="joint1")) > 0.0


def test_an_effect_that_helps_one_solver_alone_is_not_confirmed():
    world = World(7, 2)
    tests = world.sealed(truth=world.right, extended=world.right)
    for test in tests:
        test.members["extended"]["nscd-rigid"] = test.members["recalibrated"]["nscd-rigid"]
    result = gain_on(tests)
    assert float(result["fall"].sel(rival="recalibrated")) > 0.0
    assert not bool(result["confirmed"])
    assert any("solver-dependent" in caveat for caveat in gain_of_verdict(result, 0).caveats)


def test_the_verdict_gets_bounded_gains_and_says_what_they_lack():
    world = World(9, 1)
    summary = gain_of_verdict(gain_on(world.sealed(truth=world.right, extended=world.right)), 0)
    found, caveats = summary.gain, summary.caveats
    for contrast in (found.recalibrated, found.nominal, found.discrepancy):
        assert -1.0 <= contrast.lower <= contrast.estimate <= contrast.upper <= 1.0
    assert any("one sealed test" in caveat for caveat in caveats)
    summary = gain_of_verdict(gain_on(World(10, 2).sealed(np.zeros((2, 48)), np.zeros((2, 48)))), 0)
    found, caveats = summary.gain, summary.caveats
    assert (found.nominal.estimate, found.nominal.lower, found.nominal.upper) == (0.0, -1.0, 1.0)
    assert sum("nothing to gain" in caveat for caveat in caveats) == 3
