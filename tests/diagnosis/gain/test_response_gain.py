"""Gain in worlds whose truth is known: the extended model, the nominal one, or another effect."""

from dataclasses import replace

import numpy as np
import pytest
from fair_score import crps
from judged_tests import CELLS, TIME, judged

from blockshake.diagnosis.gain.response_gain import gain_of_verdict, response_gain, select_gain
from blockshake.diagnosis.verdict.verdict import NOTHING_TO_GAIN, MeasuredGain

COUNT = 24


class World:
    """Curves of sines of random size; an effect adds a curve to each cell."""

    def __init__(self, seed, n_tests):
        self.generator = np.random.default_rng(seed)
        self.n_tests = n_tests
        self.right, self.wrong = self.curves(n_tests), self.curves(n_tests)

    def curves(self, count):
        phase = np.arange(1, 5)[:, None] * TIME * 3.0
        sizes = self.generator.normal(size=(count, len(CELLS), 4))
        return np.einsum("ncf,ft->ntc", sizes, np.sin(phase))

    def sealed(self, truth, extended, placebo=None):
        """`JudgedTest` of every test with the truth in it; by kind what its members have instead."""
        added = {
            "nominal": 0.0 * truth,
            "recalibrated": 0.1 * truth,
            "extended": extended,
            "placebo": extended if placebo is None else placebo,
            "discrepancy": 0.3 * truth,
        }
        found = []
        for test in range(self.n_tests):
            drawn = self.curves(COUNT)
            members = {kind: drawn + values[test] for kind, values in added.items()}
            found.append(judged(f"s{test}", self.curves(1)[0] + truth[test], members))
        return found


def test_the_score_is_the_ranked_probability_score_and_the_floor_its_leave_one_out_mean():
    world = World(1, 2)
    tests = world.sealed(world.right, world.right)
    result = response_gain(tests)
    scores, own = [], []
    for test in tests:
        nominal, extended = (test.members[kind].to_numpy() for kind in ("nominal", "extended"))
        scale = np.sqrt(np.concatenate([nominal, extended]).var(axis=0, ddof=1).mean(axis=0))
        scores.append((crps(nominal, test.measured.to_numpy()) / scale).mean())
        left_out = [crps(np.delete(extended, k, axis=0), extended[k]) / scale for k in range(COUNT)]
        own.append(np.mean(left_out, axis=(1, 2)))
    np.testing.assert_allclose(result["score"].sel(kind="nominal"), np.mean(scores), rtol=1e-10)
    assert float(result["floor"]) == pytest.approx(np.mean(own), rel=1e-10)


@pytest.mark.parametrize("n_tests", [1, 3])
def test_the_right_effect_gains_nearly_all_and_another_nothing(n_tests):
    gains, inside, of_wrong = [], [], []
    for seed in range(8):
        world = World([seed, 7], n_tests)
        truth = 4.0 * world.right
        result = response_gain(world.sealed(truth, truth, 0.0 * truth))
        gains.append(float(result["gain"].sel(rival="recalibrated")))
        inside.append(gain_of_verdict(result, 0).gain.recalibrated.upper == 1.0)
        assert bool(result["confirmed"])
        world = World([seed, 7], n_tests)
        of_wrong.append(
            float(response_gain(world.sealed(truth, 4.0 * world.wrong))["gain"].sel(rival="recalibrated"))
        )
    # a record's own chance moves the score; the mean of eight gains is within 4 standard errors of 1
    assert np.mean(gains) == pytest.approx(1.0, abs=4.0 * np.std(gains) / np.sqrt(8))
    assert np.std(gains) < 0.3
    # the interval of 90 % reaches 1, with 4 standard errors of eight
    assert np.mean(inside) > 0.9 - 4.0 * np.sqrt(0.9 * 0.1 / 8)
    assert max(of_wrong) < 0.1


def test_without_an_effect_nothing_is_there_to_gain():
    gains, verdicts = [], []
    for seed in range(24):
        world = World([seed, 8], 2)
        result = response_gain(world.sealed(0.0 * world.right, 0.1 * world.wrong))
        gains.append(float(result["gain"].sel(rival="recalibrated")))
        verdicts.append(gain_of_verdict(result, 0).gain.recalibrated.estimate)
    # 1 in 20 records scores above 95 % of its own like: with 4 standard errors of 24
    assert np.isfinite(gains).mean() < 0.05 + 4.0 * np.sqrt(0.05 * 0.95 / 24)
    assert np.median(verdicts) == 0.0


def test_tests_to_select_by_tell_a_model_that_predicts_from_one_that_does_not():
    """The right effect is proposed; another one, one that changes no prediction, and one unseen are not measured so."""
    world = World(9, 1)
    truth = 4.0 * world.right
    right, wrong = (world.sealed(truth, one) for one in (truth, 4.0 * world.wrong))
    assert select_gain(right).gains
    assert not select_gain(wrong).gains
    assert MeasuredGain(select=select_gain(right)).proposes
    assert not MeasuredGain(select=select_gain(wrong)).proposes
    still = [replace(test, horizon=np.full(len(CELLS), -np.inf)) for test in right]
    assert select_gain(still) is select_gain([]) is None
    assert MeasuredGain().proposes
    # seed 3 of a record that does not score above its own like
    idle = World(3, 1)
    assert select_gain(idle.sealed(0.0 * idle.right, 0.1 * idle.right)) == NOTHING_TO_GAIN


def test_an_extension_that_adds_nothing_gains_nothing():
    world = World(5, 2)
    tests = world.sealed(4.0 * world.right, 0.0 * world.right)
    result = response_gain(tests)
    for name in ("gain", "gain_lower", "gain_upper"):
        assert float(result[name].sel(rival="nominal")) == 0.0
        assert float(result[name].sel(rival="placebo")) == 0.0
    assert not bool(result["confirmed"])


def test_an_effect_at_the_wrong_place_leaves_the_gain_over_it():
    world = World(6, 2)
    truth = 4.0 * world.right
    result = response_gain(world.sealed(truth, truth, 4.0 * world.wrong))
    assert float(result["gain"].sel(rival="placebo")) > 0.8
    assert float(result["score"].sel(kind="placebo")) > float(result["score"].sel(kind="nominal"))


def test_an_effect_that_helps_one_solver_alone_is_not_confirmed():
    world = World(7, 2)
    tests = world.sealed(4.0 * world.right, 4.0 * world.right)
    for test in tests:
        by_nscd = test.models == "nscd-rigid"
        test.members["extended"][by_nscd] = test.members["recalibrated"][by_nscd]
    result = response_gain(tests)
    assert float(result["gain"].sel(rival="recalibrated")) > 0.0
    assert not bool(result["confirmed"])
    assert any("solver-dependent" in caveat for caveat in gain_of_verdict(result, 0).caveats)


def test_the_verdict_gets_bounded_gains_and_says_what_they_lack():
    world = World(9, 1)
    tests = world.sealed(4.0 * world.right, 4.0 * world.right)
    summary = gain_of_verdict(response_gain(tests), 7)
    for contrast in (summary.gain.recalibrated, summary.gain.nominal, summary.gain.discrepancy):
        assert -1.0 <= contrast.lower <= contrast.estimate <= contrast.upper <= 1.0
    assert any("one sealed test" in caveat for caveat in summary.caveats)
    assert summary.runs == 7


def test_what_lies_beyond_the_horizon_is_not_judged():
    world = World(11, 1)
    (test,) = world.sealed(4.0 * world.right, 4.0 * world.right)
    early = judged("s", test.measured, test.members, np.full(len(CELLS), 1.0))
    spoilt = {kind: one.to_numpy().copy() for kind, one in test.members.items()}
    for values in spoilt.values():
        values[:, TIME > 1.0] += 100.0 * np.random.default_rng(1).normal(size=values[:, TIME > 1.0].shape)
    late = judged("s", test.measured, spoilt, np.full(len(CELLS), 1.0))
    np.testing.assert_allclose(response_gain([early])["score"], response_gain([late])["score"], rtol=1e-12)
