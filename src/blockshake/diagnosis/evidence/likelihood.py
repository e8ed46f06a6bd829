"""Gaussian likelihood of the rows of all tests, nuisances marginalised, and the evidence of columns given them."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import log_ndtr


@dataclass(frozen=True)
class Amplitudes:
    """Posterior of the amplitudes of some columns, and what they gain."""

    gain: float  # logarithm of the evidence over that of no column
    mean: np.ndarray  # float64 (n_columns,)
    covariance: np.ndarray  # float64 (n_columns, n_columns)


@dataclass(frozen=True)
class Likelihood:
    """Rows of all tests in units of their covariance."""

    roots: list  # of float64 array, shape (n_rows, n_rows); lower roots of the tests' covariances
    value: np.ndarray  # float64 (n_all_rows,); whitened rows
    nuisances: np.ndarray  # float64 (n_all_rows, n_nuisances); whitened, with standard normal amplitudes
    prior: float  # logarithm of the prior of this likelihood among others
    # what depends on the roots alone, kept where many values are held against the same causes; None: nothing is kept
    kept: dict | None = None

    @cached_property
    def ends(self):
        """First row of every test, and the number of all."""
        return np.concatenate([[0], np.cumsum([len(root) for root in self.roots])])

    @cached_property
    def _inner(self):
        # Woodbury: (C + N N')^-1 = C^-1 - C^-1 N (1 + N' C^-1 N)^-1 N' C^-1, all in whitened rows
        size = self.nuisances.shape[1]
        return np.linalg.inv(np.eye(size) + self.nuisances.T @ self.nuisances)

    @cached_property
    def nuisance_amplitudes(self):
        """Amplitudes of the nuisances at their best without any cause, (n_nuisances,)."""
        return self._inner @ (self.nuisances.T @ self.value)

    @cached_property
    def _weighted(self):
        return self.value - self.nuisances @ self.nuisance_amplitudes

    @cached_property
    def log_evidence_of_rows(self):
        """Logarithm of the whitened rows' density without any cause, up to a constant."""
        return -0.5 * float(self.value @ self._weighted) + 0.5 * np.linalg.slogdet(self._inner)[1]

    @cached_property
    def log_evidence(self):
        """Logarithm of the evidence of the rows themselves without any cause, with the prior of this likelihood."""
        # ln |C| of the whitening, which evidences under one noise model share and those of two do not
        spread = sum(np.log(np.diag(root)).sum() for root in self.roots)
        return self.log_evidence_of_rows - spread + self.prior

    def keeping(self, key, compute):
        """Result of ``compute``, which depends on the roots alone: computed once by key where anything is kept."""
        if self.kept is None:
            return compute()
        if key not in self.kept:
            self.kept[key] = compute()
        return self.kept[key]

    def whiten(self, columns):
        """Columns, one array (n_rows, n_columns) a test, in units of the covariance: (n_all_rows, n_columns)."""
        return np.concatenate(
            [self.whiten_one(index, column) for index, column in enumerate(columns)], axis=0
        )

    def whiten_one(self, test, columns):
        """Columns of one test, (n_rows, n_columns), in units of its covariance."""
        return solve_triangular(self.roots[test], columns, lower=True, check_finite=False)

    def amplitudes(self, whitened, scales, positive=False):
        """`Amplitudes` of whitened columns together.

        Parameters
        ----------
        whitened : float64 array, shape (n_all_rows, n_columns)
        scales : float64 array, shape (n_columns,)
            Standard deviations of the amplitudes' priors, about zero; None for one column whose amplitude is 1.
        positive : bool
            The first amplitude is not negative: its prior is half a normal distribution.

        Notes
        -----
        With the posterior ``N(m, C)``: ``ln B = m' C^-1 m / 2 - ln |1 + G L| / 2``, plus ``ln 2 Phi(m / s)`` of a
        positive amplitude (Rasmussen and Williams 2006, Eq. 2.30, for the marginal likelihood).
        """
        target, gram = self.normal_equations(whitened)
        if scales is None:
            return Amplitudes(float(target[0] - 0.5 * gram[0, 0]), np.ones(1), np.zeros((1, 1)))
        scales = np.atleast_1d(scales)
        precision = gram + np.diag(scales**-2.0)
        covariance = np.linalg.inv(precision)
        mean = covariance @ target
        gain = 0.5 * target @ mean - 0.5 * np.linalg.slogdet(np.eye(len(scales)) + gram * scales**2)[1]
        if positive:
            gain += np.log(2.0) + log_ndtr(mean[0] / np.sqrt(covariance[0, 0]))
        return Amplitudes(float(gain), mean, covariance)

    def normal_equations(self, whitened):
        """Projections ``H' Q y`` on the rows and ``H' Q H`` among whitened columns, nuisances free."""
        crossed = self.nuisances.T @ whitened
        gram = whitened.T @ whitened - crossed.T @ (self._inner @ crossed)
        return whitened.T @ self._weighted, gram

    def single(self, whitened, scale, positive=False, test=None):
        """`gain_of_one` of every column alone, each (n_columns,); of columns of one test alone if it is given."""
        rows = slice(None) if test is None else slice(self.ends[test], self.ends[test + 1])
        target = whitened.T @ self._weighted[rows]
        crossed = self.nuisances[rows].T @ whitened
        gram = np.einsum("ij,ij->j", whitened, whitened)
        gram = np.maximum(gram - np.einsum("ij,ij->j", crossed, self._inner @ crossed), 0.0)
        return gain_of_one(target, gram, scale, positive)

    def parts(self, whitened, test):
        """Projections of columns of one test, to be summed over tests: ``H' Q y``, diagonal of ``H' H``, ``N' H``."""
        rows = slice(self.ends[test], self.ends[test + 1])
        return (
            whitened.T @ self._weighted[rows],
            np.einsum("ij,ij->j", whitened, whitened),
            self.nuisances[rows].T @ whitened,
        )

    def gain_of_sum(self, target, square, crossed, scale):
        """`gain_of_one` of columns that are sums over tests of such parts."""
        gram = np.maximum(
            square - np.einsum("i...,i...->...", crossed, np.tensordot(self._inner, crossed, 1)), 0.0
        )
        return gain_of_one(target, gram, scale, False)

    def of_tests(self, numbers):
        """The likelihood of some tests alone, given by their numbers."""
        rows = np.concatenate([np.arange(self.ends[n], self.ends[n + 1]) for n in numbers])
        roots = [self.roots[n] for n in numbers]
        return Likelihood(roots, self.value[rows], self.nuisances[rows], self.prior)

    def given(self, columns, scales, errors):
        """The likelihood with the columns of a cause among the nuisances, and errors of its form.

        Parameters
        ----------
        columns : list of float64 array, shape (n_rows, n_columns)
            By test.
        scales : float64 array, shape (n_columns,)
        errors : list of float64 array, shape (n_rows, n_rows)
            By test: covariance of what the form of the cause leaves.
        """
        cut = [slice(a, b) for a, b in pairwise(self.ends)]
        # the form's error changes C itself: rows and nuisances go back to forces and are whitened anew
        roots = [
            np.linalg.cholesky(root @ root.T + rows) for root, rows in zip(self.roots, errors, strict=True)
        ]
        bare = Likelihood(roots, np.zeros(0), np.zeros((0, 0)), self.prior)
        raw = [
            root @ np.column_stack([self.value[rows], self.nuisances[rows]])
            for root, rows in zip(self.roots, cut, strict=True)
        ]
        again = bare.whiten([
            np.concatenate([rows, column * np.atleast_1d(scales)], axis=1)
            for rows, column in zip(raw, columns, strict=True)
        ])  # fmt: skip
        return Likelihood(roots, again[:, 0], again[:, 1:], self.prior)


def gain_of_one(target, gram, scale, positive):
    """Gain, mean and standard deviation of single amplitudes from ``H' Q y`` and ``H' Q H``."""
    precision = gram + scale**-2.0
    mean = target / precision
    gain = 0.5 * target * mean - 0.5 * np.log1p(gram * scale**2)
    if positive:
        gain = gain + np.log(2.0) + log_ndtr(mean * np.sqrt(precision))
    return gain, mean, precision**-0.5


def from_rows(covariances, values, nuisances, prior=0.0):
    """`Likelihood` of rows.

    Parameters
    ----------
    covariances, values : list of float64 array, shapes (n_rows, n_rows) and (n_rows,)
        By test.
    nuisances : list of list of float64 array, shape (n_rows,)
        By nuisance and test, each times its standard deviation.
    prior : float
        Logarithm of the prior of these covariances among others.
    """
    roots = [np.linalg.cholesky(covariance) for covariance in covariances]
    bare = Likelihood(roots, np.zeros(0), np.zeros((0, 0)), prior)
    value = bare.whiten([rows[:, None] for rows in values])[:, 0]
    stacked = [
        np.stack([column[test] for column in nuisances], axis=1) if nuisances else np.zeros((len(rows), 0))
        for test, rows in enumerate(values)
    ]
    return Likelihood(roots, value, bare.whiten(stacked), prior)
