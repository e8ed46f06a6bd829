"""Response of the features to the size of a candidate: Gaussian processes fitted to paired runs."""

from dataclasses import dataclass
from itertools import product

import numpy as np

# of the size, in units of the visible one, over which a response bends
_LENGTHS = (0.5, 1.0, 2.0, 4.0, 16.0)
# variance over that of the response at the visible size
_NOISES = (1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0)
_ONSETS = (0.3, np.inf)  # sizes from which on the scatter stays as it is; infinite: in proportion to the size
_CORRELATED_SHARE = 0.8  # share of the scatter in which features go together
_NULL_SIZE = 1e-3  # a size at which nothing is added, of the visible one
_FREEDOM_AT_LEAST = 0.5  # degrees of freedom, of two runs and fewer


@dataclass(frozen=True)
class Response:
    """Mean and standard deviation of the change of the features, at some sizes.

    Attributes
    ----------
    sizes : float64 array, shape (n_sizes,)
        In units of the visible size.
    mean, deviation : float64 arrays, shape (n_sizes, n_features)
        In units of the features' spread. The deviation holds what the fit does not know and by how much the effect
        adds more in one nominal model than in another.
    scatter : float64 array, shape (n_draws, n_features)
        By how much each run differs from what the others predict, in units of that difference's root mean square:
        features of one run differ together.
    """

    sizes: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray
    scatter: np.ndarray

    def exchanged(self, order):
        """The response with its features in another order: of the same size, and meaningless."""
        return Response(self.sizes, self.mean[:, order], self.deviation[:, order], self.scatter[:, order])

    def covariance(self):
        """Covariance of what is added at each size, float64 array, shape (n_sizes, n_features, n_features).

        Correlations are those of the scatter, of which there are few runs: shrunk by a fifth towards none.
        """
        n_draws, n_features = self.scatter.shape
        together = self.scatter.T @ self.scatter / n_draws
        correlation = (1.0 - _CORRELATED_SHARE) * np.eye(n_features) + _CORRELATED_SHARE * together
        return self.deviation[:, :, None] * correlation * self.deviation[:, None, :]


def fit_response(own_sizes, added, sizes):
    """`Response` of all features to a candidate's size.

    Parameters
    ----------
    own_sizes : float64 array, shape (n_draws,)
        Of the library's runs.
    added : float64 array, shape (n_draws, n_features)
        To the nominal run of the same draw.
    sizes : float64 array, shape (n_sizes,)
        Sizes of the response that is returned.

    Notes
    -----
    Each feature by itself: a Gaussian process (Rasmussen and Williams 2006, eqs. 2.25 and 2.26) with the kernel
    ``s^2 u u' exp(-(u - u')^2 / 2 l^2)`` and independent scatter of variance ``s^2 r u^2``, or ``s^2 r u^2 (1 +
    0.3^2) / (u^2 + 0.3^2)`` where chaos makes all of it from a small size on: at the null size nothing is added, in
    none of the draws. Left-out residuals are of their eq. 5.12. Runs are too few to tell ``l``, ``r`` and which
    scatter: predictions are averaged over a grid of them with the weight of their likelihood, ``s^2`` integrated out
    under the prior 1 / s^2, so that a few runs that happen to lie on a line do not pass for a law without scatter.
    Their variance is that of the Student t, with as many degrees of freedom as runs.
    """
    own = np.abs(own_sizes) > _NULL_SIZE
    own_sizes, added = own_sizes[own], added[own]
    count = len(own_sizes)
    freedom = count / max(count - 2.0, _FREEDOM_AT_LEAST)
    evidence, means, variances, residuals = [], [], [], []
    for length, noise, onset in product(_LENGTHS, _NOISES, _ONSETS):
        across = _kernel(sizes, own_sizes, length)
        whole = _kernel(own_sizes, own_sizes, length) + noise * np.diag(_scatter(own_sizes, onset))
        solved = np.linalg.solve(whole, added)
        square = np.maximum((added * solved).sum(axis=0), np.finfo(float).tiny)
        evidence.append(-0.5 * np.linalg.slogdet(whole)[1] - 0.5 * count * np.log(square))
        means.append(across @ solved)
        residuals.append(solved / np.diagonal(np.linalg.inv(whole))[:, None])
        left = noise * _scatter(sizes, onset) + sizes**2
        left = left - (across * np.linalg.solve(whole, across.T).T).sum(axis=1)
        variances.append(freedom * np.maximum(left, 0.0)[:, None] * square / count)
    evidence = np.array(evidence)
    weights = np.exp(evidence - evidence.max(axis=0))
    weights /= weights.sum(axis=0)
    mean = np.einsum("hf,hsf->sf", weights, np.array(means))
    second = np.einsum("hf,hsf->sf", weights, np.array(variances) + np.array(means) ** 2)
    residual = np.einsum("hf,hnf->nf", weights, np.array(residuals))
    rms = np.sqrt((residual**2).mean(axis=0))
    scatter = residual / np.where(rms > 0.0, rms, 1.0)
    return Response(np.asarray(sizes), mean, np.sqrt(np.maximum(second - mean**2, 0.0)), scatter)


def _kernel(one, other, length):
    distance = one[:, None] - other[None, :]
    return one[:, None] * other[None, :] * np.exp(-0.5 * (distance / length) ** 2)


def _scatter(sizes, onset):
    """Variance of the scatter, 1 at the visible size."""
    if np.isinf(onset):
        return sizes**2
    return sizes**2 * (1.0 + onset**2) / (sizes**2 + onset**2)
