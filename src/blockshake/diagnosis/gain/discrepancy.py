"""The statistical rival: a Gaussian process carries the error of the nominal model from test to test."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel

_VARIANCES = np.logspace(
    -2.0, 9.0, 23
)  # in units of the nominal spread, squared; effects reach 16 000 spreads
_LENGTHS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of ln(peak acceleration)
_CORRELATIONS = (0.0, 0.25, 0.5, 0.75, 1.0)  # of what is missed under two motions of the same strength


@dataclass(frozen=True)
class Condition:
    """Condition of a test.

    Attributes
    ----------
    motion : str
    peak_acceleration : float
        Of the commanded motion [m/s2].
    """

    motion: str
    peak_acceleration: float


@dataclass(frozen=True)
class Discrepancy:
    """Error of the nominal model, as a random function of the test.

    Attributes
    ----------
    features : list of str
        Those that all open tests have.
    conditions : list of Condition
        Of the open tests.
    missed : float64 array, shape (n_tests, n_features)
        Measured less predicted mean there.
    noise : float64 array, shape (n_tests,)
        Variance of what is missed that the prediction allows for by itself.
    variance : float64 array, shape (n_features,)
        Of the process.
    length : float
        The ln(peak acceleration) over which it changes.
    correlation : float
        Of what is missed under two motions of the same strength.
    """

    features: list
    conditions: list
    missed: np.ndarray
    noise: np.ndarray
    variance: np.ndarray
    length: float
    correlation: float

    def predict(self, condition):
        """Mean and standard deviation of the error in a test, each of shape (n_features,)."""
        places = _places([*self.conditions, condition], self.length, self.correlation)
        mean, deviation = np.empty((2, len(self.features)))
        for variance in np.unique(self.variance):
            own = self.variance == variance
            process = _process(variance, self.length, self.noise).fit(places[:-1], self.missed[:, own])
            of_own, spread = process.predict(places[-1:], return_std=True)
            mean[own], deviation[own] = of_own.reshape(-1), spread.reshape(-1)
        return mean, deviation


def fit_discrepancy(conditions, names, measured, members):
    """`Discrepancy` of the nominal model over the open tests.

    Parameters
    ----------
    conditions : list of Condition, length n_tests
    names : list of list of str
        By test: names of its features.
    measured : list of float64 array, shape (n_own_features,)
        By test, tamed.
    members : list of float64 array, shape (n_members, n_own_features)
        By test: the nominal members of both solvers in it.

    Notes
    -----
    Kennedy and O'Hagan (2001, J. R. Stat. Soc. B 63, section 4): measured = model + discrepancy + noise, here feature
    by feature with zero mean and the covariance ``s^2 exp(-(ln a - ln a')^2 / 2 l^2)``, times ``r`` where the motions
    differ; the noise is the members' own variance, mean over features. ``l`` and ``r`` are one for all features, ``s``
    is each one's own, of the largest likelihood on a grid, features taken for independent. They are known badly: two to
    four tests tell little of how a discrepancy changes with the motion, and this is a weak rival. It repeats under
    another motion what was missed under the first, as far as those were alike; farther away it is wide and has no mean.
    """
    common = [name for name in names[0] if all(name in own for own in names)]
    columns = [[own.index(name) for name in common] for own in names]
    missed = np.array(
        [
            one[own] - runs[:, own].mean(axis=0)
            for one, runs, own in zip(measured, members, columns, strict=True)
        ]
    )
    noise = np.array(
        [runs[:, own].var(axis=0, ddof=1).mean() for runs, own in zip(members, columns, strict=True)]
    )
    fits = {}
    for length, correlation in _shared(conditions):
        places = _places(conditions, length, correlation)
        table = np.array([_likelihoods(_process(s, length, noise), places, missed) for s in _VARIANCES])
        fits[length, correlation] = table.max(axis=0).sum(), _VARIANCES[table.argmax(axis=0)]
    best = max(fits, key=lambda shared: fits[shared][0])  # the first of equals
    return Discrepancy(common, list(conditions), missed, noise, fits[best][1], *best)


def members_with_discrepancy(discrepancy, condition, names, members):
    """Recalibrated members of a test with a draw of the discrepancy each.

    Parameters
    ----------
    discrepancy : Discrepancy
    condition : Condition
        Of the test.
    names : list of str, length n_features
    members : float64 array, shape (n_members, n_features)
        Tamed.

    Returns
    -------
    float64 array, shape (n_members, n_features)

    Notes
    -----
    Each feature gets the medians of as many strata of the normal law as there are members, in an order of its own: its
    mean and spread are met without chance. A feature that was not in all open tests stays as it is.
    """
    mean, deviation = discrepancy.predict(condition)
    count = len(members)
    strata = ndtri((np.arange(count) + 0.5) / count)
    strata /= strata.std(ddof=1)
    found = members.copy()
    for place, name in enumerate(discrepancy.features):
        if name in names:
            order = np.random.default_rng([count, *name.encode()]).permutation(count)
            found[:, names.index(name)] += mean[place] + deviation[place] * strata[order]
    return found


def _shared(conditions):
    """Lengths and correlations to try; without a pair of tests that would tell, 1 and 1/2."""
    lengths = _LENGTHS if len({one.peak_acceleration for one in conditions}) > 1 else (1.0,)
    correlations = _CORRELATIONS if len({one.motion for one in conditions}) > 1 else (0.5,)
    return [(length, correlation) for length in lengths for correlation in correlations]


def _process(variance, length, noise):
    kernel = ConstantKernel(variance, "fixed") * RBF(length, "fixed")
    return GaussianProcessRegressor(kernel, alpha=noise, optimizer=None)


def _likelihoods(process, places, missed):
    """Log likelihood of each feature: Rasmussen and Williams (2006), eq. 2.30."""
    process.fit(places, missed)
    weights = process.alpha_.reshape(missed.shape)
    constant = np.log(np.diag(process.L_)).sum() + 0.5 * len(missed) * np.log(2.0 * np.pi)
    return -0.5 * (missed * weights).sum(axis=0) - constant


def _places(conditions, length, correlation):
    """Tests as points: ln(peak acceleration), and the motions at the corners of a simplex.

    Two motions are as far apart as gives their correlation under the squared exponential.
    """
    motions = list(dict.fromkeys(one.motion for one in conditions))
    edge = length * np.sqrt(-2.0 * np.log(max(correlation, 1e-12)))
    corners = np.eye(len(motions)) * edge / np.sqrt(2.0)
    return np.array(
        [[np.log(one.peak_acceleration), *corners[motions.index(one.motion)]] for one in conditions]
    )
