"""Faults as unknowns of linear equations, each tied to zero by what a sound sensor may have, named one by one."""

from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import EFFECTS, chance_within

_VAGUE = 1e3  # times a tolerance: as good as unknown
_OVER_RIVALS = 9.0  # less in the sum of weighted squares than the best: not told apart


class Fault(NamedTuple):
    """Hypothesis of a fault: its quantity as of `EFFECTS`, its sensor, and its test where it is one test's alone."""

    quantity: str
    sensor: int
    test: int = 0


class Judged(NamedTuple):
    """Gain in the sum of squares less twice the unknowns, and the chance of a sound sensor times all hypotheses."""

    gained: float
    p: float


def posterior(equations, spread):
    """Mean and covariance of the unknowns, shapes (n,), (n, n).

    Parameters
    ----------
    equations : object
        Attributes ``normal`` (n, n), ``right`` (n,) and ``variance`` of a reading.
    spread : float64 array, shape (n,)
        Standard deviation of each unknown before anything is read.
    """
    information = equations.normal / equations.variance + np.diag(1.0 / spread**2)
    covariance = np.linalg.inv(information)
    return covariance @ (equations.right / equations.variance), covariance


def data_alone(mean, covariance, spread):
    """Estimate and covariance of some unknowns with their own prior made vague; the others keep theirs."""
    information = np.linalg.inv(covariance)
    vague = information - np.diag(1.0 / spread**2) + np.diag(1.0 / (_VAGUE * spread) ** 2)
    alone = np.linalg.inv(vague)
    return alone @ (information @ mean), alone


def freed(spread, columns):
    """Spread of the unknowns with some of them as good as unknown."""
    spread = spread.copy()
    for own in columns:
        spread[own] *= _VAGUE
    return spread


def judge(equations, spread, faults, level, freedom=np.inf):
    """`Judged` by fault.

    Parameters
    ----------
    equations, spread
        As in `posterior`.
    faults : dict of Fault to (columns, tolerance, trials)
        Its unknowns, what a sound sensor may have of them, and among how many forms the best one was chosen.
    level : Level
    freedom : float
        Degrees of freedom behind the variance.
    """
    mean, covariance = posterior(equations, spread)
    judged = {}
    for fault, (columns, tolerance, trials) in faults.items():
        estimate, alone = data_alone(mean[columns], covariance[np.ix_(columns, columns)], spread[columns])
        tied = alone + np.diag(spread[columns] ** 2)
        gained = estimate @ np.linalg.solve(tied, estimate) - 2.0 * len(columns)
        judged[fault] = Judged(
            gained, level.hypotheses * trials * chance_within(estimate, alone, tolerance, freedom)
        )
    return judged


def clearest(judged, level, names, allowed=lambda fault: True):
    """Fault that gains most of those beyond chance, its p, and the rivals that gain nearly as much; None without.

    Parameters
    ----------
    judged : dict of Fault to Judged
    level : Level
    names : sequence of str
        Of the sensors.
    allowed : callable
        Whether a fault may be named.
    """
    clear = [fault for fault, one in judged.items() if one.p < level.chance and allowed(fault)]
    if not clear:
        return None
    best = max(clear, key=lambda fault: judged[fault].gained)
    rivals = tuple(
        (EFFECTS[fault.quantity], (names[fault.sensor],), fault.quantity)
        for fault, one in judged.items()
        if fault[:2] != best[:2] and judged[best].gained - one.gained < _OVER_RIVALS
    )
    return best, judged[best].p, rivals
