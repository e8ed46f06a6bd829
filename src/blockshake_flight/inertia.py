"""The inertia of a body as its flights tell it: the ratios of its moments, and never their size."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake_flight.tumbling import tumbling

# logarithms of the moments along x, y, z of zero sum, per logarithm of the ratios of y and of z to x
OF_RATIOS = np.array([[-1.0, 2.0, -1.0], [-1.0, -1.0, 2.0]]) / 3.0
_MOST_FLIGHTS = 60  # flights, the longest ones: what a flight tells grows with a high power of its length
_ROUNDS = 2  # of Gauss and Newton
_CHANGE = 0.01  # of a logarithm, by which derivatives are found
_DETERMINED = 0.1  # standard deviation of a logarithm, from which on the flights do not tell it


@lru_cache(maxsize=16)
def with_inertia(tracked, logs):
    """The same tests of a body whose moments along its axes are ``exp(logs)`` times as large, logs a tuple of 3.

    A product of inertia goes with the root of both factors. The same campaign where no mass has such moments.
    """
    factor = np.exp(0.5 * np.array(logs))
    tensor = tracked.structure.inertia[tracked.body] * np.outer(factor, factor)
    elements = tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    try:
        stated = tracked.structure.with_parameters({f"bodies.{tracked.name}.inertia": elements})
    except InputError:
        return tracked
    return replace(tracked, structure=stated) if any(logs) else tracked


def seen_ratios(tracked, arcs):
    """Logarithms of the ratios of the moments of inertia about y and z to that about x, over those of the structure.

    By the rotations in flight, with their standard deviations: two float64 arrays (2,); None where these do not tell.

    Notes
    -----
    Without a moment the spin obeys Euler's equations ``I omega' = (I omega) x omega``, which a factor on I leaves as
    they are. Start and momentum of each flight are those of `tumbling`, so that the derivative of what is left is that
    with these at their best (Golub and Pereyra 1973, SIAM J. Numer. Anal. 10). The covariance is that of the flights'
    scores (White 1980, Econometrica 48), as errors of the tracking turn with the body.
    """
    if any(len(arc.axes) < 3 for arc in arcs):
        return None
    longest, ratios = sorted(arcs, key=lambda arc: -arc.time[-1])[:_MOST_FLIGHTS], np.zeros(2)
    for _ in range(_ROUNDS):
        here, *shifted = (
            [_left(tracked, arc, ratios + change) for arc in longest]
            for change in (np.zeros(2), *(_CHANGE * np.eye(2)))
        )
        designs = [(left - np.array(moved)).T / _CHANGE for left, *moved in zip(here, *shifted, strict=True)]
        precision = sum(design.T @ design for design in designs)
        if np.linalg.cond(precision) > 1e12:
            return None
        scores = np.array([design.T @ left for design, left in zip(designs, here, strict=True)])
        ratios = ratios + np.clip(np.linalg.solve(precision, scores.sum(axis=0)), -0.5, 0.5)
    scores = np.linalg.solve(precision, (scores - scores.mean(axis=0)).T)
    deviations = np.sqrt((scores**2).sum(axis=1))
    return (ratios, deviations) if deviations.max() < _DETERMINED else None


def _left(tracked, arc, ratios):
    """Turns that the best tumbling with some ratios leaves of a flight, (3 n,) [rad]."""
    path, _ = tumbling(with_inertia(tracked, tuple((ratios @ OF_RATIOS).tolist())), arc)
    return (Rotation.from_matrix(arc.rotation) * path.inv()).as_rotvec().ravel()
