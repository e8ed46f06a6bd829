"""Evidence of causes from outcomes, and chances of a fall by weighted models."""

from typing import NamedTuple

import numpy as np
import scipy
import xarray as xr
from scipy.special import expit, logsumexp

from blockshake.diagnosis.outcomes.emulator import DISCREPANCIES, emulate
from blockshake.diagnosis.outcomes.unknowns import UNKNOWNS
from blockshake.store import load_made

_MODELS, _SEED = 2048, 43
_MISREAD = 0.005  # chance that an outcome is otherwise than it was noted


class SimulatedOutcomes(NamedTuple):
    """Simulated and measured outcomes of a campaign."""

    tests: tuple  # of str; all, in the campaign's order
    runs: tuple  # of xarray.Dataset; of `simulate_outcomes`, all tests of one solver each
    emulators: tuple  # of Emulator; the same order

    def rows(self, names):
        """Numbers of some tests."""
        return [self.tests.index(name) for name in names]


def load_outcomes(files):
    """`SimulatedOutcomes` of the files of all batches, solver by solver."""
    batches = [load_made(path) for path in files]
    solvers = dict.fromkeys(batch.attrs["model"] for batch in batches)
    runs = tuple(
        xr.concat([batch for batch in batches if batch.attrs["model"] == solver], "test")
        for solver in solvers
    )
    return SimulatedOutcomes(tuple(runs[0]["test"].to_numpy().tolist()), runs, tuple(map(emulate, runs)))


class Posterior(NamedTuple):
    """Models with their weights.

    ``shares`` float64 (n_models, n_unknowns); ``weights`` (n_solvers, n_discrepancies, n_models), of sum 1;
    ``evidence``: logarithm of the likelihood's mean over the models.
    """

    shares: np.ndarray
    weights: np.ndarray
    evidence: float

    def chance(self, outcomes, rows):
        """Chance of a fall in the tests of some numbers, (n_rows,)."""
        by_solver = [
            np.einsum("dtm,dm->t", emulator.chance(rows, self.shares), weights)
            for emulator, weights in zip(outcomes.emulators, self.weights, strict=True)
        ]
        return np.sum(by_solver, axis=0)

    def quantiles(self, unknown, probabilities):
        """Quantiles of one unknown's share."""
        order = np.argsort(self.shares[:, unknown], kind="stable")
        reached = np.cumsum(self.weights.sum(axis=(0, 1))[order])
        return self.shares[
            order[np.minimum(np.searchsorted(reached, probabilities), len(order) - 1)], unknown
        ]

    def members(self, count):
        """Shares of ``count`` models, drawn evenly along the weights."""
        reached = np.cumsum(self.weights.sum(axis=(0, 1)))
        return self.shares[np.searchsorted(reached, (np.arange(count) + 0.5) / count * reached[-1])]


def unknowns_of(causes):
    """Numbers of the unknowns that some causes stand for."""
    return [number for number, unknown in enumerate(UNKNOWNS) if unknown.cause in causes]


def posterior(outcomes, rows, fell, causes):
    """`Posterior` of the tests of some numbers, in which the body fell or not (bool array), with some causes acting.

    The unknowns of the causes have shares up to 1, all others up to their usual ones, evenly spread before the
    outcomes are known; solvers and discrepancies are alike likely.
    """
    shares = _drawn(causes)
    log = np.empty((len(outcomes.emulators), len(DISCREPANCIES), len(shares)))
    for solver, emulator in enumerate(outcomes.emulators):
        chance = _MISREAD + (1.0 - 2.0 * _MISREAD) * emulator.chance(rows, shares)
        log[solver] = np.log(np.where(np.asarray(fell)[:, None], chance, 1.0 - chance)).sum(axis=1)
    total = logsumexp(log)
    return Posterior(shares, np.exp(log - total), float(total - np.log(log.size)))


def prior(outcomes):
    """`Posterior` of no test at all: the undamaged models, alike likely, without a discrepancy."""
    shares = _drawn(())
    weights = np.zeros((len(outcomes.emulators), len(DISCREPANCIES), len(shares)))
    weights[:, 0] = 1.0 / (len(outcomes.emulators) * len(shares))
    return Posterior(shares, weights, 0.0)


def _drawn(causes):
    wide = unknowns_of(causes)
    bounds = [1.0 if number in wide else unknown.usual for number, unknown in enumerate(UNKNOWNS)]
    return (2.0 * scipy.stats.qmc.Halton(len(UNKNOWNS), seed=_SEED).random(_MODELS) - 1.0) * bounds


def fitted_curve(outcomes, rows, fell):
    """Chance of a fall in every test by logistic regression on the logarithms of peak acceleration and velocity.

    Fitted to the tests of some numbers; slopes have a normal prior of standard deviation 3 per standard deviation of
    the logarithms, so that outcomes that a line parts have a fit.
    """
    run = outcomes.runs[0]
    peaks = np.log(np.clip([run["pga"].to_numpy(), run["pgv"].to_numpy()], 1e-6, None))
    peaks = ((peaks.T - peaks.mean(axis=1)) / np.maximum(peaks.std(axis=1), 1e-9)).T
    columns, sign = np.vstack([np.ones(peaks.shape[1]), peaks]).T, np.where(fell, 1.0, -1.0)

    def loss(slopes):
        return (
            np.logaddexp(0.0, -sign * (columns[rows] @ slopes)).sum() + 0.5 * ((slopes[1:] / 3.0) ** 2).sum()
        )

    return expit(columns @ scipy.optimize.minimize(loss, np.zeros(3)).x)
