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
    by_size = [_with_force(likelihood, points, size) for size in _SIZES]
    evidence = np.array([of_size[0] for of_size in by_size])
    best = int(np.argmax(evidence))
    size = np.array([_SIZES[best]])
    columns = [rows[:, None] / size for rows in by_size[best][1]]
    fit = Fit({}, float(evidence[best]), columns, size, size, np.zeros((1, 1)))
    return Explanation("unknown-force", points.place, float(mean_evidence(evidence)), (fit,))


def _with_force(likelihood, points, size):
    """Gain of a force of one size, and its rows by test."""
    roots, kernels = [], []
    for test, rows_there in enumerate(points.by_test):
        kernel = size**2 * np.exp(-np.abs(rows_there.time[:, None] - rows_there.time) / _MEMORY)
        column = likelihood.whiten_one(test, np.diag(rows_there.unit))
        spread = column @ kernel @ column.T
        spread[np.diag_indices(len(spread))] += 1.0
        roots.append(np.linalg.cholesky(spread))
        kernels.append((kernel, column))
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
    rows = []
    for point, rows_of, root, (kernel, column) in zip(points.by_test, cut, roots, kernels, strict=True):
        unexplained = likelihood.value[rows_of] - likelihood.nuisances[rows_of] @ best
        force = kernel @ column.T @ _solve(root.T, _solve(root, unexplained), lower=False)
        rows.append(point.unit * force)
    return log - likelihood.log_evidence_of_rows, rows


def _solve(root, values, lower=True):
    return solve_triangular(root, values, lower=lower, check_finite=False)


FORM = LoadShape("unknown-force", "a force of no known form", "size", "N")
