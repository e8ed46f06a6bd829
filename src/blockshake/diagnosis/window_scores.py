"""What innovations of short windows say of effects whose tangents are known: t values and log ratios."""

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln, logsumexp

_FREEDOM = 5.0  # of Student's t: a single odd window does not decide
_DRAWS = 400  # of the bootstrap
_NEAR = 5.0  # standard deviations about the likeliest size that are looked at closely
_NOTHING = 1e-12  # of information: the effect does not show in these windows
_BLOCK = 2  # windows: from turn to turn and back, one cycle of rocking


@dataclass(frozen=True)
class Innovations:
    """Measured less simulated ends of the windows of a test, and what is uncertain in them.

    Attributes
    ----------
    values : float64 array, shape (n_windows, n_coordinates)
        NaN where nothing was measured or a run ended early.
    covariance : float64 array, shape (n_windows, n_coordinates, n_coordinates)
        By readings and by errors of the start, independent from window to window.
    shared : float64 array, shape (n_windows, n_coordinates, n_shared)
        By what is not known of the model and is the same in all windows: each column times a number of unit variance.
    """

    values: np.ndarray
    covariance: np.ndarray
    shared: np.ndarray

    def whitened(self, tangent):
        """Values, shared columns and a tangent in units of the windows' own scatter; unknown values are zero.

        Returns
        -------
        values : float64 array, shape (n_windows, n_coordinates)
        shared : float64 array, shape (n_windows, n_coordinates, n_shared)
        tangent : float64 array, shape (n_windows, n_coordinates)
        count : int64 array, shape (n_windows,)
            Known coordinates.
        logarithm : float
            Of the determinant of the factors by which all were divided.
        """
        known = np.isfinite(self.values) & np.isfinite(tangent) & np.isfinite(self.shared).all(axis=2)
        both = known[:, :, None] & known[:, None, :]
        # an unknown coordinate by itself with unit variance: it adds nothing
        covariance = np.where(both, self.covariance, np.eye(self.values.shape[1]))
        factors = np.linalg.cholesky(covariance)
        inverse = np.linalg.inv(factors)
        parts = [np.where(known, part, 0.0)[..., None] for part in (self.values, tangent)]
        own, along = (np.matmul(inverse, part)[..., 0] for part in parts)
        shared = np.matmul(inverse, np.where(known[..., None], self.shared, 0.0))
        logarithm = float(np.log(np.diagonal(factors, axis1=1, axis2=2)).sum())
        return own, shared, along, known.sum(axis=1), logarithm


@dataclass(frozen=True)
class WindowScore:
    """What the windows of a test say of one effect.

    Attributes
    ----------
    t : float
        Size of the likeliest effect over its standard deviation, what is shared taken out [1].
    size : float
        That size, in units of the visible one.
    density, null_density : float
        Log densities of all windows, averaged over the prior of sizes, and without the effect.
    error : float
        Standard error of their difference by bootstrap over blocks of windows [1].
    """

    t: float
    size: float
    density: float
    null_density: float
    error: float


def score_windows(innovations, tangent, sizes, seed):
    """Score of one effect.

    Parameters
    ----------
    innovations : Innovations
    tangent : float64 array, shape (n_windows, n_coordinates)
        Change of the simulated ends by an effect of the visible size.
    sizes : float64 array, shape (n_sizes,)
        Increasing, over the prior of the size, each value as likely as another, in units of the visible one.
    seed : sequence of int
        Of the bootstrap.

    Returns
    -------
    WindowScore

    Notes
    -----
    The score test (Rao 1948) with what is shared as nuisance of known variance: with e = size g + N eta + noise, eta of
    unit variance, t = g' V^-1 e / sqrt(g' V^-1 g), V = W + N N'. Log densities are Student's t of
    each window's distance, eta at its likeliest for the size. Windows of one test share its input and its
    model, so its standard error says nothing of other tests.
    """
    values, shared, along, count, logarithm = innovations.whitened(tangent)
    n_shared = shared.shape[2]
    flat = shared.reshape(-1, n_shared)
    spread = np.eye(n_shared) + flat.T @ flat
    gain = np.linalg.solve(spread, flat.T)
    # alike for all sizes, not for two solvers
    constant = logarithm + 0.5 * np.linalg.slogdet(spread)[1]

    def without_shared(part):
        return part - (shared @ (gain @ part.ravel()))

    information = float(np.sum(along * without_shared(along)))
    slope = float(np.sum(along * without_shared(values)))
    likeliest = slope / information if information > _NOTHING else 0.0
    grid = _refined(sizes, likeliest, 1.0 / np.sqrt(max(information, _NOTHING)))
    by_window = np.empty((len(grid) + 1, len(values)))
    price = np.empty(len(grid) + 1)
    for place, size in enumerate([0.0, *grid]):
        left = values - size * along
        eta = gain @ left.ravel()
        squares = ((left - shared @ eta) ** 2).sum(axis=1)
        by_window[place] = _log_student(squares, count)
        price[place] = 0.5 * eta @ eta + constant
    total = by_window.sum(axis=1) - price
    best = 1 + int(np.argmax(total[1:]))
    return WindowScore(
        t=likeliest * np.sqrt(information),
        size=likeliest,
        density=float(logsumexp(total[1:], b=np.gradient(grid)) - np.log(grid[-1] - grid[0])),
        null_density=float(total[0]),
        error=_bootstrap_error(by_window[best] - by_window[0], seed),
    )


def _refined(sizes, likeliest, deviation):
    """Sizes of the prior, and as fine as the windows tell them apart about the likeliest."""
    near = likeliest + deviation * np.linspace(-_NEAR, _NEAR, len(sizes))
    return np.unique(np.concatenate([sizes, np.clip(near, sizes[0], sizes[-1])]))


def _log_student(squares, count):
    """Log density of Student's t with unit scale in as many dimensions as are known, by window."""
    constant = (
        gammaln(0.5 * (_FREEDOM + count)) - gammaln(0.5 * _FREEDOM) - 0.5 * count * np.log(_FREEDOM * np.pi)
    )
    return constant - 0.5 * (_FREEDOM + count) * np.log1p(squares / _FREEDOM)


def _bootstrap_error(values, seed):
    """Standard error of a sum over windows, from draws of blocks of neighbours, the last beside the first."""
    n_windows = len(values)
    n_blocks = int(np.ceil(n_windows / _BLOCK))
    first = np.random.default_rng(seed).integers(n_windows, size=(_DRAWS, n_blocks))
    places = (first[:, :, None] + np.arange(_BLOCK)) % n_windows
    sums = values[places.reshape(_DRAWS, -1)[:, :n_windows]].sum(axis=1)
    return float(sums.std(ddof=1))
