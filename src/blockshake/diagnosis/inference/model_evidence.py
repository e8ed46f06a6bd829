"""Predictive density of a test's features by one solver, without and with each candidate at each size."""

import numpy as np
from scipy.special import gammaln
from sklearn.covariance import LedoitWolf

from blockshake.diagnosis.inference.response import fit_response

_FREEDOM = 5.0  # of Student's t, of unit variance: a single odd feature does not decide
# of a feature's spread over all nominal draws: what no draw of one model shows it knows nothing of
_UNKNOWN_SPREAD = 0.1
_GRID_SIZES = 21
_LOG_NORMALISATION = (
    gammaln(0.5 * (_FREEDOM + 1.0)) - gammaln(0.5 * _FREEDOM) - 0.5 * np.log((_FREEDOM - 2.0) * np.pi)
)


def size_grid(sizes):
    """Sizes at which a candidate is tried: over what its library spans, the null size in it."""
    return np.linspace(min(sizes.min(), 0.0), max(sizes.max(), 0.0), _GRID_SIZES)


class ModelEvidence:
    """Predictive densities of one test by one model.

    Parameters
    ----------
    nominal : float64 array, shape (n_draws, n_features)
        Tamed features.
    with_effect : dict of str to float64 array, shape (n_own_draws, n_features)
        By candidate; draw k is nominal draw k with the effect.
    sizes : dict of str to float64 array, shape (n_own_draws,)
    left_out : int, optional
        A draw that is taken for a measurement and so is none of the library's.
    whole : ModelEvidence, optional
        The same with no draw left out: what a draw has no part in is taken from there.

    Notes
    -----
    Mean and covariance are those of the nominal draws, shrunk after Ledoit and Wolf (2004), since features outnumber
    draws; a candidate adds the mean and the scatter of its `Response`. The whitened features are taken for independent
    draws of Student's t: one t for all of them together would forgive a model that is wrong in every feature as
    easily as one that is wrong in its scale.
    """

    def __init__(self, nominal, with_effect, sizes, left_out=None, whole=None):
        kept = np.arange(len(nominal)) != left_out
        fit = LedoitWolf().fit(nominal[kept])
        n_features = nominal.shape[1]
        self.mean = fit.location_
        self.covariance = fit.covariance_ + _UNKNOWN_SPREAD**2 * np.eye(n_features)
        self.responses = {}
        for key, runs in with_effect.items():
            own = np.flatnonzero(kept[: len(runs)])
            if whole is not None and len(own) == len(runs):
                self.responses[key] = whole.responses[key]
                continue
            self.responses[key] = fit_response(
                sizes[key][own], runs[own] - nominal[own], size_grid(sizes[key])
            )
        self._whitened = {}

    def nominal(self, features):
        """Log density of features by the model alone, and their squared distance."""
        if None not in self._whitened:
            self._whitened[None] = self._factors(np.zeros((1, 1, 1)))
        density, square = self._densities(features, np.zeros((1, len(features))), self._whitened[None])
        return float(density[0]), float(square[0])

    def candidate(self, key, features):
        """The same with a candidate, at each size of its grid: two float64 arrays, shape (n_sizes,)."""
        response = self.responses[key]
        if key not in self._whitened:
            self._whitened[key] = self._factors(response.covariance())
        return self._densities(features, response.mean, self._whitened[key])

    def with_response(self, features, added, covariance):
        """The same with anything that adds a mean, shape (n_sizes, n_features), and a covariance, one axis more."""
        return self._densities(features, added, self._factors(covariance))

    def _factors(self, added):
        """Inverses of the covariances' Cholesky factors, and the logarithms of these factors' determinants."""
        lower = np.linalg.cholesky(self.covariance + added)
        logarithm = np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1)
        return np.linalg.inv(lower), logarithm

    def _densities(self, features, added, whitening):
        inverse, logarithm = whitening
        left = np.einsum("sij,sj->si", inverse, features - self.mean - added)
        each = _LOG_NORMALISATION - 0.5 * (_FREEDOM + 1.0) * np.log1p(left**2 / (_FREEDOM - 2.0))
        return each.sum(axis=1) - logarithm, (left**2).sum(axis=1)
