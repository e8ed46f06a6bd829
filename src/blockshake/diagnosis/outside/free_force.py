"""A force along x on a block of which only the size and the memory are known: what any named form must explain."""

from itertools import pairwise

import numpy as np
from scipy.linalg import solve_triangular

from blockshake.diagnosis.evidence.explanation import Explanation, Fit, mean_evidence
from blockshake.diagnosis.outside.form import LoadShape

_SIZES = (300.0, 1e3, 3e3, 1e4)  # N
_MEMORY = 0.05  # s


def explain_free_force(likelihood, points):
    """`Explanation` of a Gaussian process of force at one point.

    Notes
    -----
    Its evidence is that of the rows with the process in their covariance. Its rows are those of its posterior mean at
    the best size (Rasmussen and Williams 2006, Eq. 2.25), nuisances at their best with it.
    """
    columns = likelihood.keeping(points.place, lambda: _columns(likelihood, points))
    by_size = [_with_force(likelihood, points, columns, size) for size in _SIZES]
    evidence = np.array([of_size[0] for of_size in by_size])
    best = int(np.argmax(evidence))
    size = np.array([_SIZES[best]])
    rows = _posterior_mean(likelihood, points, columns, _SIZES[best], *by_size[best][1:])
    fit = Fit(
        {}, float(evidence[best]), [of_test[:, None] / size for of_test in rows], size, size, np.zeros((1, 1))
    )
    return Explanation("unknown-force", points.place, float(mean_evidence(evidence)), (fit,))


def _columns(likelihood, points):
    """Whitened rows of a unit force at every instant, by test."""
    return [likelihood.whiten_one(test, np.diag(there.unit)) for test, there in enumerate(points.by_test)]


def _kernel(there, size):
    return size**2 * np.exp(-np.abs(there.time[:, None] - there.time) / _MEMORY)


def _roots(points, columns, size):
    """Lower roots of the covariance of the whitened rows with a force of one size, by test."""
    roots = []
    for there, column in zip(points.by_test, columns, strict=True):
        spread = column @ _kernel(there, size) @ column.T
        spread[np.diag_indices(len(spread))] += 1.0
        roots.append(np.linalg.cholesky(spread))
    return roots


def _with_force(likelihood, points, columns, size):
    """Gain of a force of one size, the roots of its covariance, and the nuisances at their best with it."""
    roots = likelihood.keeping((points.place, size), lambda: _roots(points, columns, size))
    cut = [slice(a, b) for a, b in pairwise(likelihood.ends)]
    value = np.concatenate(
        [_solve(root, likelihood.value[rows_of]) for root, rows_of in zip(roots, cut, strict=True)]
    )
    nuisances = np.concatenate(
        [_solve(root, likelihood.nuisances[rows_of]) for root, rows_of in zip(roots, cut, strict=True)]
    )
    inner = np.eye(nuisances.shape[1]) + nuisances.T @ nuisances
    drawn = nuisances.T @ value
    best = np.linalg.solve(inner, drawn)
    log = -0.5 * (value @ value - drawn @ best) - sum(np.log(np.diag(root)).sum() for root in roots)
    log -= 0.5 * np.linalg.slogdet(inner)[1]
    return log - likelihood.log_evidence_of_rows, roots, best


def _posterior_mean(likelihood, points, columns, size, roots, nuisances):
    """Rows of the posterior mean of the force, by test."""
    rows = []
    cut = [slice(a, b) for a, b in pairwise(likelihood.ends)]
    for there, column, rows_of, root in zip(points.by_test, columns, cut, roots, strict=True):
        unexplained = likelihood.value[rows_of] - likelihood.nuisances[rows_of] @ nuisances
        force = _kernel(there, size) @ column.T @ _solve(root.T, _solve(root, unexplained), lower=False)
        rows.append(there.unit * force)
    return rows


def _solve(root, values, lower=True):
    return solve_triangular(root, values, lower=lower, check_finite=False)


FORM = LoadShape("unknown-force", "a force of no known form", "size", "N")
