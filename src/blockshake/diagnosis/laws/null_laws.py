"""Laws of the nominal model: their values over simulated draws, with numerics and sensors in them."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.laws.law_table import law_of

_FEWEST = 4  # draws that tell a law; with fewer the table's value stands


class NullLaw(NamedTuple):
    """Mean and standard deviation of a law over draws, after its transform; ``draws`` that told it."""

    mean: float
    spread: float
    draws: int


def tamed(name, value):
    """Value of a law on its scale: linear near zero and logarithmic far from it where the table has a scale."""
    scale = law_of(name).scale
    return np.sign(value) * np.log1p(np.abs(value) / scale) if scale else value


def tamed_error(name, value, error):
    """Standard error on that scale."""
    scale = law_of(name).scale
    return error / (scale + abs(value)) if scale else error


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
        law, told = law_of(name), tamed(name, column[np.isfinite(column)])
        if len(told) >= _FEWEST:
            # the prediction of one more draw
            spread = np.std(told, ddof=1) * np.sqrt(1.0 + 1.0 / len(told))
            found[name] = NullLaw(float(told.mean()), float(max(spread, law.spread / 3.0)), len(told))
        elif np.isfinite(law.usual):
            found[name] = NullLaw(float(tamed(name, law.usual)), law.spread, len(told))
    return found
