import numpy as np
import pytest

from blockshake.study.sampling.correlation_control import anneal_level, arrange

ROUNDING = 1e-12  # of sums of products of order one


def _standard(seed, shape):
    values = np.random.default_rng(seed).normal(size=shape)
    return (values - values.mean(axis=0)) / values.std(axis=0)


def _error(standard, target):
    """Root mean square over the pairs of variables of correlation minus target [1]."""
    off = (np.corrcoef(standard, rowvar=False) - target)[np.triu_indices(len(target), k=1)]
    return np.sqrt(np.mean(off**2))


def _level(scores, target, temperature, n_trials=3000, least=np.inf):
    generator = np.random.default_rng(5)
    n_samples, n_variables = scores.shape
    column = generator.integers(n_variables, size=n_trials)
    first = generator.integers(n_samples, size=n_trials)
    second = (first + 1 + generator.integers(n_samples - 1, size=n_trials)) % n_samples
    chance = generator.uniform(size=n_trials)
    order = np.tile(np.arange(n_samples)[:, None], (1, n_variables))
    best = order.copy()
    moved = scores.copy()
    found = anneal_level(target, column, first, second, chance, temperature, least, moved, order, best)
    return found, moved, order, best, (column, first, second, chance)


def _naive_level(scores, target, temperature, column, first, second, chance):
    """The same with every correlation computed anew; smallest error met and last scores."""
    scores = scores.copy()
    error, least = _error(scores, target), np.inf
    for j, a, b, u in zip(column, first, second, chance, strict=True):
        scores[[a, b], j] = scores[[b, a], j]
        after = _error(scores, target)
        if after > error and u >= np.exp(-(after - error) / temperature):
            scores[[a, b], j] = scores[[b, a], j]
            continue
        error = after
        least = min(least, error)
    return least, scores


@pytest.mark.parametrize("temperature", [1e-9, 3e-3, 1.0])
def test_kernel_follows_the_naive_loop(temperature):
    scores, target = _standard(1, (20, 4)), np.eye(4)
    found, moved, order, best, trials = _level(scores, target, temperature)
    least, last = _naive_level(scores, target, temperature, *trials)
    np.testing.assert_array_equal(moved, last)
    assert found == pytest.approx(least, abs=ROUNDING)
    # what stands where, at the end and at the best
    np.testing.assert_array_equal(np.take_along_axis(scores, order, axis=0), moved)
    at_best = _error(np.take_along_axis(scores, best, axis=0), target)
    assert at_best == pytest.approx(found, abs=ROUNDING)


def test_a_level_that_finds_nothing_better_leaves_the_best():
    scores = _standard(1, (20, 4))
    found, _, _, best, _ = _level(scores, np.eye(4), 1.0, least=1e-9)
    assert found == 1e-9
    np.testing.assert_array_equal(best, np.tile(np.arange(20)[:, None], (1, 4)))


def test_arrange_permutes_every_column_once():
    order = arrange(_standard(2, (30, 5)), np.eye(5), seed=3, effort=1)
    np.testing.assert_array_equal(np.sort(order, axis=0), np.tile(np.arange(30)[:, None], (1, 5)))


def test_more_effort_never_gives_a_larger_error():
    columns, target = _standard(2, (12, 4)), np.eye(4)
    errors = [
        _error(np.take_along_axis(columns, arrange(columns, target, 3, effort), axis=0), target)
        for effort in (1, 2, 4, 8, 16)
    ]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < errors[0]


def test_the_order_does_not_hang_on_the_last_digits_of_the_columns():
    # few samples of few variables reach their best pairing several times, and exponentials differ between processors
    for seed in range(10):
        n_variables = 2 + seed % 2
        columns = np.exp(_standard(seed, (10, n_variables)))
        last_digits = np.random.default_rng(seed).integers(-2, 3, columns.shape) * 2.0**-52
        one, other = (
            arrange(c, np.eye(n_variables), seed, 8) for c in (columns, columns * (1 + last_digits))
        )
        np.testing.assert_array_equal(one, other)
