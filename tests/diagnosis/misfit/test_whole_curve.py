import numpy as np
import pytest
from scipy.stats import kstest

from blockshake.diagnosis.misfit.whole_curve import whole_curve_probability
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
        found.append(whole_curve_probability(_one(curves), members))
    # moved to the middle of its step, p is uniform but for steps of 1/40, which the test at 400 cannot see
    jitter = generator.uniform(0.0, 1.0 / 40.0, 400)
    assert kstest(np.array(found) - jitter, "uniform").pvalue > 0.01
    # 2 / 40 = 0.05: 20 expected, standard deviation 4.4
    assert abs(np.sum(np.array(found) <= 0.05) - 20) < 3 * 4.4


def test_a_shifted_curve_is_found():
    """A shift by 4 standard deviations in the middle, of one channel of two."""
    generator = np.random.default_rng(12)
    found = [
        whole_curve_probability(_one(_curves(generator, 1, shift=6.0)), _curves(generator, 59)) <= 0.05
        for _ in range(40)
    ]
    assert np.mean(found) > 0.9


def test_units_do_not_matter_and_order_neither():
    generator = np.random.default_rng(15)
    measured, members = _one(_curves(generator, 1, 2.0)), _curves(generator, 49)
    result = whole_curve_probability(measured, members)
    scaled = whole_curve_probability(
        {"b": 1e6 * measured["b"], "a": measured["a"]}, {"b": 1e6 * members["b"], "a": members["a"]}
    )
    assert scaled == result
    shuffled = {name: values[::-1] for name, values in members.items()}
    assert whole_curve_probability(measured, shuffled) == result


def test_equal_curves_are_never_rejected():
    members = {"a": np.ones((30, 5))}
    assert whole_curve_probability({"a": np.ones(5)}, members) == 1.0


def test_a_run_cut_short_is_farthest_out():
    generator = np.random.default_rng(16)
    members = _curves(generator, 40)
    measured = {name: values[7].copy() for name, values in members.items()}
    others = {name: np.delete(values, 7, axis=0) for name, values in members.items()}
    whole = whole_curve_probability(measured, others)
    others["a"][:20, 60:] = np.nan  # more of the others are farther out than a whole curve can be
    assert whole_curve_probability(measured, others) > whole


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
            whole_curve_probability(measured, wrong)
