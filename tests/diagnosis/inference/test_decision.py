"""The decision on libraries whose law is known: error rates, sets, the unknown, and what is excluded.

Features are Gaussian: a nominal scatter with a few strong directions; an effect adds a direction times its size.
"""

import numpy as np
import pytest

from blockshake.diagnosis.inference import calibration
from blockshake.diagnosis.inference.calibration import NONE, as_case, chance_of_none, library_cases
from blockshake.diagnosis.inference.candidate_scores import ScoreLibrary
from blockshake.diagnosis.inference.decide import decide

N_FEATURES, N_NOMINAL, N_OWN, N_TESTS = 15, 40, 10, 2
MODELS = ("ls-dem", "nscd-rigid")
KEYS = ("weak-joint@a-b", "weak-joint@b-c", "table-pitch", "vertical-motion")
PLACES = {key: {} for key in KEYS}


class World:
    """Two models that differ in their mean, and four candidates; two of them are places of one effect."""

    def __init__(self, seed):
        generator = np.random.default_rng(seed)
        self.mixing = generator.normal(0.0, 0.3, (N_TESTS, N_FEATURES, 3))
        self.mean = {model: generator.normal(0.0, 0.5, (N_TESTS, N_FEATURES)) for model in MODELS}
        self.direction = {key: 1.5 * generator.normal(0.0, 1.0, (N_TESTS, N_FEATURES)) for key in KEYS}
        self.outside = 1.5 * generator.normal(0.0, 1.0, (N_TESTS, N_FEATURES))

    def draw(self, model, generator):
        """Features of one nominal draw, (N_TESTS, N_FEATURES): the same parameters in both tests."""
        parameters = generator.normal(0.0, 1.0, 3)
        noise = generator.normal(0.0, 0.3, (N_TESTS, N_FEATURES))
        return self.mean[model] + self.mixing @ parameters + noise

    def library(self, seed):
        generator = np.random.default_rng(seed)
        sizes = 2.5 * ((0.5 + 0.618 * np.arange(N_OWN)) % 1.0)
        tests = [{model: {} for model in MODELS} for _ in range(N_TESTS)]
        for model in MODELS:
            nominal = np.array([self.draw(model, generator) for _ in range(N_NOMINAL)])
            for test in range(N_TESTS):
                tests[test][model]["nominal"] = nominal[:, test]
            for key in KEYS:
                scatter = 1.0 + generator.normal(0.0, 0.05, N_OWN)
                added = (sizes * scatter)[:, None, None] * self.direction[key]
                for test in range(N_TESTS):
                    tests[test][model][key] = nominal[:N_OWN, test] + added[:, test]
        return ScoreLibrary(tests, {model: dict.fromkeys(KEYS, sizes) for model in MODELS})


@pytest.fixture(scope="module")
def world():
    return World(1)


@pytest.fixture(scope="module")
def library(world):
    return world.library(2)


@pytest.fixture(scope="module")
def cases(library):
    return library_cases(library)


def _decide(world, library, cases, added, generator, model="ls-dem"):
    return decide(library, list(world.draw(model, generator) + added), cases, PLACES)


def test_clean_readings_are_called_an_effect_in_one_of_twenty(world, library, cases):
    generator = np.random.default_rng(3)
    p = np.array(
        [
            chance_of_none(as_case(library.score(list(world.draw(MODELS[number % 2], generator)))), cases)
            for number in range(200)
        ]
    )
    # 5 % of 200 with 4 standard errors of a binomial, and of the 80 reference draws' own scatter
    assert (p <= 0.05).mean() < 0.05 + 4.0 * np.sqrt(0.05 * 0.95 * (1 / 200 + 1 / 80))
    assert p.mean() == pytest.approx(0.5, abs=4.0 * np.sqrt((1 / 200 + 1 / 80) / 12.0))


@pytest.mark.parametrize("key", KEYS)
def test_a_clear_effect_is_named_with_its_place_and_size(key, world, library, cases):
    generator = np.random.default_rng(4)
    effect = key.partition("@")[0]
    for model in MODELS:
        decision = _decide(world, library, cases, 1.3 * world.direction[key], generator, model)
        assert (decision.decision, decision.causes) == ("named", (effect,))
        best = decision.candidates[0]
        assert (best.key, best.model) == (key, model)
        # a grid step of 0.12, and 5 % that an effect differs from model to model
        assert best.size == pytest.approx(1.3, abs=0.25)
        assert np.dot(best.weights, best.sizes) == pytest.approx(1.3, abs=0.25)


def test_of_many_draws_the_first_are_judged_by_all(library, cases, monkeypatch):
    monkeypatch.setattr(calibration, "MOST_JUDGED", 3)
    judged = library_cases(library)
    by_model = [[case for case in cases if case.truth == NONE][place : place + 3] for place in (0, N_NOMINAL)]
    assert [case for case in judged if case.truth == NONE] == by_model[0] + by_model[1]


def test_what_no_candidate_explains_is_unknown(world, library, cases):
    generator = np.random.default_rng(5)
    decision = _decide(world, library, cases, 1.5 * world.outside, generator)
    assert decision.decision == "unknown"
    assert decision.causes == ()
    assert decision.p_none < 0.05


def test_two_effects_that_do_the_same_are_both_in_the_set(world):
    twin = World(1)
    twin.direction["vertical-motion"] = twin.direction["table-pitch"]
    library = twin.library(2)
    cases = library_cases(library)
    generator = np.random.default_rng(6)
    causes = [
        _decide(
            twin, library, cases, generator.uniform(0.6, 2.4) * twin.direction["table-pitch"], generator
        ).causes
        for _ in range(40)
    ]
    # each is in the set at 0.9, over the sizes of the library, and adequate at 0.95; less 4 standard errors
    assert np.mean(["table-pitch" in one for one in causes]) > 0.85 - 4.0 * np.sqrt(0.85 * 0.15 / 40)
    assert np.mean([set(one) == {"table-pitch", "vertical-motion"} for one in causes]) > 0.5


def test_without_a_finding_sizes_are_excluded(world, library, cases):
    decision = decide(library, list(world.mean["ls-dem"]), cases, PLACES)
    assert decision.decision == "none"
    # the library's largest sizes are seen, its smallest are not
    for size in decision.shown_above.values():
        assert 0.05 < size < 1.5


def test_an_effect_in_the_library_is_in_the_set_at_the_rate_promised(world, library, cases):
    generator = np.random.default_rng(8)
    kept = []
    for number in range(60):
        key = KEYS[number % len(KEYS)]
        size = generator.uniform(0.6, 2.4)
        decision = _decide(world, library, cases, size * world.direction[key], generator, MODELS[number % 2])
        if decision.p_none <= 0.05:
            kept.append(key.partition("@")[0] in decision.causes)
    assert len(kept) > 40
    # in the set at 0.9 and adequate at 0.95: 0.85 together, less 4 standard errors
    assert np.mean(kept) > 0.85 - 4.0 * np.sqrt(0.85 * 0.15 / len(kept))


def test_cases_know_their_truth(library, cases):
    truths = [case.truth for case in cases]
    assert truths.count(NONE) == len(MODELS) * N_NOMINAL
    assert truths.count("weak-joint") == 2 * len(MODELS) * N_OWN
