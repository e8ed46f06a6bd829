"""Constancy of an effect: a cause has one size in all tests; an effect that compensates for a cause has not."""

from scipy.stats import chi2


def constancy(by_test):
    """Chance of sizes as different from test to test as these, if the effect has one.

    Parameters
    ----------
    by_test : float64 array, shape (n_tests, n_sizes)
        Log density of each test at each size.

    Returns
    -------
    float
        1 with a single test.

    Notes
    -----
    Likelihood ratio of one size a test against one size for all, twice its logarithm against chi-square with
    ``n_tests - 1`` degrees of freedom (Wilks 1938); of Gaussian likelihoods it is Cochran's Q (1954). A test that
    does not tell the size has a flat density and adds nothing.
    """
    statistic = 2.0 * float(by_test.max(axis=1).sum() - by_test.sum(axis=0).max())
    return float(chi2.sf(statistic, len(by_test) - 1)) if len(by_test) > 1 else 1.0
