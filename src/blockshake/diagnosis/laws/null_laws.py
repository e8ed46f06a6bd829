"""Laws of the nominal model: their values over simulated draws, with numerics and sensors in them."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.laws.law_table import law_of

_FEWEST = 4  # draws that tell a law; with fewer the table's value stands


class NullLaw(NamedTuple):
    """Null distribution of a law in one test, on the law's scale.

    ``mean`` and ``spread``, its standard deviation; ``values`` (n_draws,) of the draws, NaN where a draw does not tell
    the law, and empty where the table's usual value stands.
    """

    mean: float
    spread: float
    values: np.ndarray


def tamed(name, value):
    """Value of a law on its scale: linear near zero and logarithmic far from it where the table has a scale."""
    scale = law_of(name).scale
    return np.sign(value) * np.log1p(np.abs(value) / scale) if scale else value


def untamed(name, value):
    """Value in the law's unit of one on its scale."""
    scale = law_of(name).scale
    return np.sign(value) * scale * np.expm1(np.abs(value)) if scale else value


def tamed_error(name, value, error):
    """Standard error on that scale."""
    scale = law_of(name).scale
    return error / (scale + abs(value)) if scale else error


def untamed_error(name, value, error):
    """Standard error in the law's unit, at a value in the law's unit, of one on its scale."""
    scale = law_of(name).scale
    return error * (scale + abs(value)) if scale else error


def null_laws(names, values):
    """Null distribution of each law of a test.

    Parameters
    ----------
    names : sequence of str
    values : float64 array, shape (n_draws, n_laws)
        Of nominal draws by all solvers together: a law is one of statics, and a solver one more form of numerics.

    Returns
    -------
    dict of str to NullLaw
        Laws without a draw that tells them and without a usual value are left out.
    """
    found = {}
    for name, column in zip(names, np.asarray(values).T, strict=True):
        law, of_draws = law_of(name), tamed(name, column)
        told = of_draws[np.isfinite(of_draws)]
        if len(told) >= _FEWEST:
            # the prediction of one more draw
            spread = _scatter(told) * np.sqrt(1.0 + 1.0 / len(told))
            found[name] = NullLaw(float(told.mean()), float(max(spread, law.spread / 3.0)), of_draws)
        elif np.isfinite(law.usual):
            found[name] = NullLaw(float(tamed(name, law.usual)), law.spread, np.empty(0))
    return found


def covariance(nulls):
    """Covariance between tests of the null distributions of one law.

    Parameters
    ----------
    nulls : sequence of NullLaw
        One a test. Draw k is the same structure in all tests.

    Returns
    -------
    float64 array, shape (n_tests, n_tests)
        Tests share the friction, the bearing and the nodes of a structure, so that its laws err together. Spread that
        the draws do not show, of the table's least and usual values, is the same in all tests.
    """
    shared = np.empty((len(nulls), len(nulls)))
    for i, one in enumerate(nulls):
        for j, other in enumerate(nulls):
            shared[i, j] = one.spread**2 if i == j else _shared(one, other)
    return shared


def _shared(one, other):
    """Covariance of two null distributions, of other tests."""
    scatters = [_scatter(null.values[np.isfinite(null.values)]) for null in (one, other)]
    unseen = [
        np.sqrt(max(null.spread**2 - own**2, 0.0)) for null, own in zip((one, other), scatters, strict=True)
    ]
    of_draws = scatters[0] * scatters[1]
    if len(one.values) == len(other.values):
        both = np.isfinite(one.values) & np.isfinite(other.values)
        if both.sum() >= _FEWEST:
            of_draws = max(float(np.cov(one.values[both], other.values[both])[0, 1]), 0.0)
    return min(of_draws + unseen[0] * unseen[1], one.spread * other.spread)


def _scatter(told):
    return float(np.std(told, ddof=1)) if len(told) > 1 else 0.0
