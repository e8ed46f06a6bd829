"""One size from the sizes that several tests give."""

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

FORM = 0.15  # share of a size by which tests may differ in what a law's form leaves out
_UPPER = 0.95  # quantile of a two-sided interval of 90 %


def mean_of_tests(values, errors, form=FORM):
    """Mean of a size over tests, and half the width of its interval of 90 %.

    Parameters
    ----------
    values, errors : float64 arrays, shape (n_tests,)
        Size by test and its standard error.
    form : float, optional
        Share of the size by which tests may differ beyond their errors.

    Returns
    -------
    mean, half : float

    Notes
    -----
    Tests are weighted by their errors and by the share. The interval is Student's by the scatter between the tests,
    never narrower than the errors alone give. One test shows no scatter: it has its error and the share.
    """
    values, errors = np.asarray(values, dtype=float), np.asarray(errors, dtype=float)
    variance = errors**2 + (form * np.median(np.abs(values))) ** 2
    weight = variance**-1 / (variance**-1).sum()
    mean, count = float(weight @ values), len(values)
    if count == 1:
        return mean, float(norm.ppf(_UPPER) * variance[0] ** 0.5)
    scatter = np.sqrt(weight @ (values - mean) ** 2 / (count - 1))
    own = norm.ppf(_UPPER) * np.sqrt(weight**2 @ errors**2)
    return mean, float(max(student.ppf(_UPPER, count - 1) * scatter, own))
