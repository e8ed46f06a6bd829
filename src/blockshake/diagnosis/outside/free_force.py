"""A force along x on a block of which only the size and the memory are known: what any named form must explain."""

from itertools import pairwise

import numpy as np
from scipy.linalg import solve_triangular

from blockshake.diagnosis.evidence.explanation import Explanation, Fit, mean_evidence
from blockshake.diagnosis.outside.form import Form

_SIZES = (300.0, 1e3, 3e3, 1e4)  # N
_MEMORY = 0.05  # s


def explain_free_force(likelihood, points):
    """`Explanation` of a Gaussian process of force at one point; ``values`` has its size and history.

    Notes
    -----
    Its evidence is that of the rows with the process in their covariance. The history is its posterior mean at the best
    size (Rasmussen and Williams 2006, Eq. 2.25), nuisances at their best beside it.
    """
    found = [_with_force(likelihood, points, size) for size in _SIZES]
    evidence = np.array([one[0] for one in found])
    best = int(np.argmax(evidence))
    columns = [one[:, None] for one in found[best][1]]
    values = {"size": _SIZES[best], "history": found[best][2]}
    fit = Fit(values, float(evidence[best]), columns, np.ones(1), np.ones(1), np.zeros((1, 1)))
    return Explanation("unknown-force", points.place, float(mean_evidence(evidence)), (fit,), np.zeros(0))


def _with_force(likelihood, points, size):
    """Gain of a force of one size, its rows by test, and its history by test."""
    roots, kernels = [], []
    for test, one in enumerate(points.by_test):
        kernel = size**2 * np.exp(-np.abs(one.time[:, None] - one.time) / _MEMORY)
        column = likelihood.whiten_one(test, np.diag(one.unit))
        spread = column @ kernel @ column.T
        spread[np.diag_indices(len(spread))] += 1.0
        roots.append(np.linalg.cholesky(spread))
        kernels.append((kernel, column))
    ends = likelihood.ends
    cut = [slice(a, b) for a, b in pairwise(ends)]
    value = np.concatenate(
        [_solve(root, likelihood.value[own]) for root, own in zip(roots, cut, strict=True)]
    )
    nuisances = np.concatenate(
        [_solve(root, likelihood.nuisances[own]) for root, own in zip(roots, cut, strict=True)]
    )
    inner = np.eye(nuisances.shape[1]) + nuisances.T @ nuisances
    drawn = nuisances.T @ value
    best = np.linalg.solve(inner, drawn)
    log = -0.5 * (value @ value - drawn @ best) - sum(np.log(np.diag(root)).sum() for root in roots)
    log -= 0.5 * np.linalg.slogdet(inner)[1]
    histories, rows = {}, []
    for number, (own, root) in enumerate(zip(cut, roots, strict=True)):
        left = likelihood.value[own] - likelihood.nuisances[own] @ best
        kernel, column = kernels[number]
        force = kernel @ column.T @ _solve(root.T, _solve(root, left), lower=False)
        point = points.by_test[number]
        histories[points.tests[number]] = {"time": point.time, "force": force}
        rows.append(point.unit * force)
    return log - likelihood.log_evidence_of_rows, rows, histories


def _solve(root, values, lower=True):
    return solve_triangular(root, values, lower=lower, check_finite=False)


FORM = Form("unknown-force", "a force of no known form", "size", "N")
