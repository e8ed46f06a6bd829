"""Chance of a fall in a test by a model of any shares, from a few simulated outcomes of every test."""

from typing import NamedTuple

import numpy as np
import scipy
from scipy.special import log_ndtr, logsumexp, ndtr

# rad: below it a body hardly rocks, and a lean predicts nothing about a fall
_SMALLEST = np.radians(0.3)
_LARGEST = np.radians(20.0)  # of the lean that counts as a fall
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(9)  # of what a test has beyond its motion's peaks
_LOG_WEIGHTS = np.log(_WEIGHTS / _WEIGHTS.sum())
_RIDGE = 2.0  # standard deviation of the prior of a slope, and of the logarithm of either spread
DISCREPANCIES = np.array(
    [0.0, 0.25, 0.5, 1.0, 2.0]
)  # of measured from simulated leans, as logarithms; equally probable


class Emulator(NamedTuple):
    """Logarithm of the lean over all shares, normal, of every test."""

    slopes: np.ndarray  # float64 (n_slopes,); by share and its square
    # float64 (n_tests, n_nodes); logarithm of the lean at shares of 0 [ln rad] at each of the nodes of what
    # the test has of its own
    means: np.ndarray
    log_weights: np.ndarray  # float64 (n_tests, n_nodes); of the nodes, after the simulated leans of the test
    spread: float  # standard deviation of that logarithm given the node

    def chance(self, tests, shares):
        """Chance of a fall, float64 (n_discrepancies, n_tests, n_models), by models of ``shares`` (n_models, n)."""
        spread = np.hypot(self.spread, DISCREPANCIES)
        moved = _columns(shares) @ self.slopes
        chance = np.zeros((len(spread), len(tests), len(shares)))
        for mean, weight in zip(self.means[tests].T, np.exp(self.log_weights[tests]).T, strict=True):
            above = mean[:, None] + moved - np.log(_LARGEST)
            chance += weight[:, None] * ndtr(above / spread[:, None, None])
        return chance


def _columns(shares):
    return np.concatenate([shares, shares**2], axis=-1)


def emulate(outcomes):
    """`Emulator` of the simulated outcomes of all tests by one solver.

    ``outcomes`` is the Dataset of `simulate_outcomes`. The logarithm of the lean goes with the logarithms of the
    motion's peak acceleration and velocity, with the shares and their squares, with a random effect of each test, and
    with a residual. A lean below 0.3 degrees is known to be that alone, and a fall to be beyond 20 degrees
    (Tobin 1958, Econometrica 26); runs that were not finished are left out.
    """
    lean = outcomes["lean"].to_numpy()
    known = np.isfinite(lean) | np.isposinf(lean)
    value = np.log(np.clip(np.where(known, lean, _SMALLEST), _SMALLEST, _LARGEST))
    low, high = known & (lean <= _SMALLEST), known & (lean >= _LARGEST)
    between = known & ~low & ~high
    columns = _columns(outcomes["share"].to_numpy())
    peaks = np.log([outcomes["pga"].to_numpy(), outcomes["pgv"].to_numpy()]).T
    peaks = np.clip(peaks, np.log(1e-6), None)
    of_motion = np.column_stack([np.ones(len(peaks)), peaks, peaks**2, peaks.prod(axis=1)])
    # standardised, so that the search steps alike in all
    middle, scale = of_motion[:, 1:].mean(axis=0), of_motion[:, 1:].std(axis=0)
    of_motion[:, 1:] = (of_motion[:, 1:] - middle) / np.maximum(scale, 1e-9)
    n_motion, n_shares = of_motion.shape[1], columns.shape[2]

    def parts(parameters):
        level, slopes = parameters[:n_motion], parameters[n_motion : n_motion + n_shares]
        own, spread = np.exp(parameters[-2:])
        means = (of_motion @ level)[:, None] + own * _NODES
        z = (value[:, :, None] - means[:, None, :] - (columns @ slopes)[:, :, None]) / spread
        log = np.where(
            between[:, :, None],
            -0.5 * z**2 - np.log(spread * np.sqrt(2.0 * np.pi)),
            np.where(low[:, :, None], log_ndtr(z), np.where(high[:, :, None], log_ndtr(-z), 0.0)),
        )
        return means, log.sum(axis=1) + _LOG_WEIGHTS, slopes, spread

    def loss(parameters):
        _, log, slopes, _ = parts(parameters)
        prior = 0.5 * ((slopes / _RIDGE) ** 2).sum() + 0.5 * ((parameters[-2:] / _RIDGE) ** 2).sum()
        return prior - logsumexp(log, axis=1).sum()

    start = np.zeros(n_motion + n_shares + 2)
    start[0] = value[known].mean()
    best = scipy.optimize.minimize(
        loss, start, method="L-BFGS-B", bounds=[(None, None)] * (len(start) - 2) + [(-4.0, 2.0)] * 2
    )
    means, log, slopes, spread = parts(best.x)
    return Emulator(slopes, means, log - logsumexp(log, axis=1, keepdims=True), float(spread))
