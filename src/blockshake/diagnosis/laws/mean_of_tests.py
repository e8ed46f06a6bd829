"""One size from the sizes that several tests give."""

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

FORM = 0.15  # share of a size by which a law may err in what its form leaves out
_UPPER = 0.95  # quantile of a two-sided interval of 90 %


def mean_of_tests(values, errors, form=FORM):
    """Mean of a size over tests, and half the width of its interval of 90 %.

    Parameters
    ----------
    values, errors : float64 arrays, shape (n_tests,)
        Size by test and its standard error.
    form : float, optional
        Share of the size by which all tests together, and each test, may err beyond their errors.

    Returns
    -------
    mean, half : float

    Notes
    -----
    Tests are weighted by their errors and by the share. The interval is Student's by the scatter between the tests,
    never narrower than the errors alone give, and the share beside it: a form that errs alike in all tests scatters in
    none. One test shows no scatter: it has its error and the share.
    """
    values, errors = np.asarray(values, dtype=float), np.asarray(errors, dtype=float)
    variance = errors**2 + (form * np.median(np.abs(values))) ** 2
    weight = variance**-1 / (variance**-1).sum()
    mean, count = float(weight @ values), len(values)
    half = norm.ppf(_UPPER) * np.sqrt(weight**2 @ errors**2)
    if count > 1:
        scatter = np.sqrt(weight @ (values - mean) ** 2 / (count - 1))
        half = max(student.ppf(_UPPER, count - 1) * scatter, half)
    return mean, float(np.hypot(half, norm.ppf(_UPPER) * form * mean))
