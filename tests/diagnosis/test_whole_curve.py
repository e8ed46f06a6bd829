import numpy as np
import pytest
from scipy.stats import kstest, norm, qmc

from blockshake.diagnosis.whole_curve import calibrated_probability, draw_probabilities, whole_curve_test
from blockshake.errors import InputError

TIME = np.linspace(0.0, 1.0, 120)


def _curves(generator, count, shift=0.0):
    """Two channels with common parameters, smooth in time, of other units and lengths."""
    weights = generator.normal(size=(count, 4))
    shapes = np.array([np.sin(np.pi * (k + 1) * TIME) for k in range(4)])
    first = weights @ shapes + 0.05 * generator.normal(size=(count, len(TIME)))
    second = 1e-3 * np.tanh(weights[:, :2] @ shapes[:2])[:, ::2] + 1e-5 * generator.normal(size=(count, 60))
    return {"a": first + shift * np.sin(np.pi * TIME), "b": second}


def _one(curves, row=0):
    return {name: values[row] for name, values in curves.items()}


def test_p_is_uniform_for_exchangeable_curves():
    """Exactness under exchangeability (Myllymaki et al. 2017, sect. 3): p takes k / 40 with equal chance."""
    generator = np.random.default_rng(11)
    found = []
    for _ in range(400):
        curves = _curves(generator, 40)
        members = {name: values[1:] for name, values in curves.items()}
        found.append(whole_curve_test(_one(curves), members).p)
    # moved to the middle of its step, p is uniform but for steps of 1/40, which the test at 400 cannot see
    jitter = generator.uniform(0.0, 1.0 / 40.0, 400)
    assert kstest(np.array(found) - jitter, "uniform").pvalue > 0.01
    # 2 / 40 = 0.05: 20 expected, standard deviation 4.4
    assert abs(np.sum(np.array(found) <= 0.05) - 20) < 3 * 4.4


def test_a_shifted_curve_is_found():
    """A shift by 4 standard deviations in the middle, of one channel of two."""
    generator = np.random.default_rng(12)
    found = [
        whole_curve_test(_one(_curves(generator, 1, shift=6.0)), _curves(generator, 59)).p <= 0.05
        for _ in range(40)
    ]
    assert np.mean(found) > 0.9


def test_the_envelope_is_left_where_and_only_where_p_says_so():
    """Intrinsic graphical interpretation (Myllymaki and Mrkvicka 2020)."""
    generator = np.random.default_rng(13)
    left, rejected = [], []
    for case in range(60):
        result = whole_curve_test(_one(_curves(generator, 1, shift=0.1 * case)), _curves(generator, 59))
        left.append(len(result.stretches) > 0)
        rejected.append(result.p <= 0.05)
    assert left == rejected
    assert 5 < sum(left) < 55


def test_stretches_name_place_side_and_size():
    generator = np.random.default_rng(14)
    members = _curves(generator, 99)
    measured = {"a": np.zeros(120), "b": np.zeros(60)}
    measured["a"][30:110] = -50.0
    measured["a"][40] = np.nan
    result = whole_curve_test(measured, members)
    assert result.p == 0.01
    rows = result.stretches[result.stretches["curve"] == "a"].to_dict("records")
    low = next(row for row in rows if row["side"] == "below")
    assert (low["first"], low["last"]) == (30, 109)
    width = (result.upper["a"] - result.lower["a"])[[*range(30, 40), *range(41, 110)]]
    assert low["excess"] == pytest.approx(
        ((result.lower["a"][30:110] + 50.0)[np.r_[0:10, 11:80]] / width).max()
    )
    assert np.isnan(result.lower["a"][40])


def test_units_do_not_matter_and_order_neither():
    generator = np.random.default_rng(15)
    measured, members = _one(_curves(generator, 1, 2.0)), _curves(generator, 49)
    result = whole_curve_test(measured, members)
    scaled = whole_curve_test(
        {"b": 1e6 * measured["b"], "a": measured["a"]}, {"b": 1e6 * members["b"], "a": members["a"]}
    )
    assert scaled.p == result.p
    shuffled = {name: values[::-1] for name, values in members.items()}
    assert whole_curve_test(measured, shuffled).p == result.p


def test_equal_curves_are_never_rejected():
    members = {"a": np.ones((30, 5))}
    assert whole_curve_test({"a": np.ones(5)}, members).p == 1.0


def test_a_run_cut_short_is_farthest_out():
    generator = np.random.default_rng(16)
    members = _curves(generator, 40)
    members["a"][7, 60:] = np.nan
    result = whole_curve_test(_one(_curves(generator, 1)), members)
    assert result.measure[8] == result.measure.min()
    assert np.isfinite(result.upper["a"]).all()


def test_latin_hypercube_members_are_calibrated_by_independent_draws():
    """Curves linear in four variables: members of a hypercube cover the marginals more evenly than draws do."""
    generator = np.random.default_rng(17)
    design = norm.ppf(qmc.LatinHypercube(4, rng=generator).random(50))
    shapes = np.array([np.sin(np.pi * (k + 1) * TIME) for k in range(4)])
    members = {"a": design @ shapes + 0.05 * generator.normal(size=(50, 120))}
    draws = {"a": generator.normal(size=(300, 4)) @ shapes + 0.05 * generator.normal(size=(300, 120))}
    found = draw_probabilities(draws, members)
    # whatever the error rate is with these members, a further draw's calibrated p is uniform by construction
    calibrated = [calibrated_probability(p, np.delete(found, place)) for place, p in enumerate(found)]
    assert np.mean(np.array(calibrated) <= 0.05) <= 0.05 + 1e-9
    # given 50 members the share below 0.05 scatters around 2 / 51 by some 3 % (beta) and 1.1 % (300 draws)
    assert 0.0 <= np.mean(found <= 0.05) < 0.04 + 3 * 0.032


def test_what_cannot_be_ranked_is_refused():
    members = {"a": np.random.default_rng(0).normal(size=(30, 5))}
    for measured, wrong, words in (
        ({"b": np.ones(5)}, members, "same curves"),
        ({"a": np.ones(4)}, members, "as many members"),
        ({"a": np.full(5, np.nan)}, members, "at least one reading"),
        ({"a": np.ones(5)}, {"a": members["a"][:10]}, "at least 19"),
        ({"a": np.ones(5)}, {"a": np.where(np.arange(5) == 2, np.nan, members["a"])}, "no gaps"),
    ):
        with pytest.raises(InputError, match=words):
            whole_curve_test(measured, wrong)
