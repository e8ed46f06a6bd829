import numpy as np
import pytest
from scipy.signal import lfilter

from blockshake.diagnosis.features.coloured_regression import coloured_regression

N_TIMES, N_CASES = 600, 300


def _coloured(generator, memory, shape):
    return lfilter([1.0], [1.0, -memory], generator.normal(size=(*shape, 400 + N_TIMES)), axis=-1)[..., 400:]


@pytest.mark.parametrize("memory", [0.0, 0.6, 0.9])
def test_intervals_hold_the_truth_under_colour(memory):
    """95 % intervals over 300 cases; regressor and residual both first-order with this memory."""
    generator = np.random.default_rng(8)
    regressor = _coloured(generator, memory, (N_CASES,))
    response = 2.0 * regressor + _coloured(generator, memory, (N_CASES,))
    held = held_white = 0
    for x, y in zip(regressor, response, strict=True):
        found, error = coloured_regression(y, x[:, None])
        held += abs(found[0] - 2.0) < 1.96 * error[0]
        residual = y - y.mean() - found[0] * (x - x.mean())
        held_white += abs(found[0] - 2.0) < 1.96 * residual.std() / np.sqrt(((x - x.mean()) ** 2).sum())
    # expected 285, standard deviation 3.8; the estimate of the colour costs up to some 5 % at a memory of 0.9, where
    # 600 readings are worth 63
    assert held > 285 - 3 * 3.8 - 0.05 * N_CASES * (memory > 0.8)
    assert held < 285 + 3 * 3.8
    if memory == 0.9:
        assert held_white < 0.6 * N_CASES


def test_exact_signals_give_exact_slopes():
    time = np.arange(400) / 200.0
    regressors = np.column_stack([np.sin(9 * time), np.cos(9 * time), time])
    response = regressors @ [3e-4, -2e-3, 0.5] + 7.0
    response[50:60] = np.nan
    found, error = coloured_regression(response, regressors)
    np.testing.assert_allclose(found, [3e-4, -2e-3, 0.5], rtol=1e-9)
    assert (error < 1e-9).all()


@pytest.mark.parametrize("regressors", [np.ones((400, 1)), np.zeros((400, 1)), np.arange(15.0)[:, None]])
def test_what_cannot_be_told_has_an_infinite_error(regressors):
    found, error = coloured_regression(np.arange(float(len(regressors))), regressors)
    assert found[0] == 0.0
    assert np.isinf(error[0])
