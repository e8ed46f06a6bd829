import numpy as np
import pytest

from blockshake.forces.local_fit import fit_locally

TIME = np.arange(400) / 200.0
WIDTH = 0.015


def test_a_parabola_is_kept():
    x = 1.0 + 2.0 * TIME - 3.0 * TIME**2
    values, _ = fit_locally(TIME, x[:, None], TIME[50:350], WIDTH)
    np.testing.assert_allclose(values[0, :, 0], x[50:350], atol=1e-12)
    np.testing.assert_allclose(values[1, :, 0], 2.0 - 6.0 * TIME[50:350], atol=1e-10)
    np.testing.assert_allclose(values[2, :, 0], -6.0, atol=1e-8)


@pytest.mark.parametrize("missing", [[], [198], [203, 204, 205], [190, 191, 207], [196, 197, 198, 206]])
def test_accelerations_are_smoothed_by_weights_that_are_nowhere_negative(missing):
    """Jacobi (1841); de Boor and Pinkus (2003): whatever the gaps."""
    read = np.ones((len(TIME), 1))
    read[missing] = np.nan
    # a unit impulse of acceleration at each time in turn
    kinks = np.maximum(TIME[:, None] - TIME[None, 150:250], 0.0) * read
    weights = fit_locally(TIME, kinks, TIME[[200]], WIDTH)[0][2, 0]
    assert np.isfinite(weights).all()
    assert weights.min() > -1e-9 * weights.max()
    assert weights.sum() / 200.0 == pytest.approx(1.0, rel=1e-3)


def test_without_gaps_the_kernel_is_the_gaussian():
    kinks = np.maximum(TIME[:, None] - TIME[None, 150:250], 0.0)
    weights = fit_locally(TIME, kinks, TIME[[200]], WIDTH)[0][2, 0]
    gaussian = np.exp(-0.5 * ((TIME[150:250] - TIME[200]) / WIDTH) ** 2) / (WIDTH * np.sqrt(2.0 * np.pi))
    np.testing.assert_allclose(weights, gaussian, atol=0.02 * gaussian.max())


@pytest.mark.parametrize("degree", [0, 2])
def test_variances_are_those_of_white_noise(degree):
    noise = np.random.default_rng(1).normal(size=(len(TIME), 4000))
    values, variances = fit_locally(TIME, noise, TIME[[200]], WIDTH, degree)
    np.testing.assert_allclose(values[:, 0].var(axis=1), variances[:, 0, 0], rtol=0.08)


def test_what_readings_do_not_surround_is_not_told():
    x = TIME[:, None].copy()
    x[190:215] = np.nan
    values, variances = fit_locally(TIME, x, TIME, WIDTH)
    assert np.isnan(values[2, [0, 1, 200, 202, -1], 0]).all()
    assert np.isinf(variances[2, 200, 0])
    assert np.isfinite(values[2, 150:180, 0]).all()
