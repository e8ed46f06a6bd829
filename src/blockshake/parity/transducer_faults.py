"""Faults of a displacement transducer: wrong sign, gain, an end elsewhere, an end that slips, one after the other."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import chance_of_misfit
from blockshake.parity.kinds import gain, place, slip
from blockshake.parity.kinds.polarity import POLARITY
from blockshake.parity.linear_faults import Equations, Unknowns, clearest, data_alone

_COLUMNS = gain.OF_TRANSDUCER, place.OF_END, place.OF_REFERENCE_END
_SEGMENT = 5  # means over which coloured noise averages out, half a second
_EDGE = 3  # means before and after a slip
_MOST_FAULTS = 4
_NOTHING = 1e-9  # m and m/s, as of readings without any noise


class TransducerCheck(NamedTuple):
    """Gain, reading over truth less 1, with its standard error [1], NaN where nothing tells it; and the findings."""

    gain: float
    gain_error: float
    findings: tuple


def hypotheses(n_tests):
    """Number of faults that are looked at: sign, gain, two places, and a slip in each test."""
    return 4 + n_tests


def check_transducer(name, held, level):
    """`TransducerCheck` of one transducer: the clearest fault first, until the rest is within the tolerances.

    Parameters
    ----------
    name : str
    held : dict of str to HeldReading
        By test; empty where the markers see nothing of it.
    level : Level

    Notes
    -----
    What remains of the means of a test is ``c + g e + J d + s H + l r`` with constant c, gain g of the expectation e,
    wrong places d of both ends, a slip s from some time on, and a lag l of the rate r. Constants and lags are taken
    out; the other unknowns are tied to zero by half their tolerance, but for those that have been named. The time of a
    slip is the likeliest one, and its chance counts once for each time that was tried.

    A gain or a place is looked for only where a visible one would leave as much as the noise of a mean: noise in a
    column makes its coefficient too small, of a gain by less than the square of this, a tenth of its tolerance.
    """
    tests, findings = tuple(held), []
    if not held:
        return TransducerCheck(np.nan, np.nan, ())
    readings, turned = (
        np.concatenate([_without_lag(one.left, one) for one in whole])
        for whole in (held.values(), [one.reversed() for one in held.values()])
    )
    after = (turned**2).sum()
    chance = chance_of_misfit((readings**2).sum(), after, max(after / len(turned), _NOTHING**2))
    if level.hypotheses * chance < level.chance:
        findings.append(POLARITY.finding((name,), level.hypotheses * chance, tests))
        held = {test: one.reversed() for test, one in held.items()}
    unknowns, named, slips = Unknowns((*_COLUMNS, slip.OF_END), 1, len(tests)), {}, {}
    while True:
        spread = unknowns.freed(named)
        made = _equations(list(held.values()), unknowns, spread, slips)
        told = {fault: rest for fault, rest in made.faults.items() if fault not in named}
        best = clearest(made.equations, spread, told, level, (name,))
        if best is None or len(named) == _MOST_FAULTS:
            break
        named[best[0]] = best[1:]
        if best[0].column is slip.OF_END:
            slips[best[0].test] = made.slips[best[0].test]
    mean, covariance = made.equations.posterior(spread)
    for fault, (p, rivals) in named.items():
        estimate, square, where = (
            *_estimate(unknowns.of(fault), made.faults[fault][0], mean, covariance, spread),
            tests,
        )
        if fault.column is slip.OF_END:
            where, row = (tests[fault.test],), slips[fault.test]
            before, after = held[where[0]].time[row - 1 : row + 1]
            estimate = np.array([estimate[0], 0.5 * (before + after)])
            square = np.diag([square[0, 0], (after - before) ** 2 / 12.0])
        findings.append(fault.column.kind.finding((name,), p, where, estimate, square, rivals))
    (of_gain,) = unknowns.faults(gain.OF_TRANSDUCER)
    if of_gain not in made.faults:
        return TransducerCheck(np.nan, np.nan, tuple(findings))
    size, error = data_alone(mean[:1], covariance[:1, :1], spread[:1])
    return TransducerCheck(float(size[0]), float(np.sqrt(error[0, 0])), tuple(findings))


def _without_lag(values, held):
    """Means (n_means, ...) without what a lag of the clocks leaves in them."""
    late = held.late / max(np.linalg.norm(held.late), _NOTHING)
    return values - np.multiply.outer(late, late @ values)


class _Made(NamedTuple):
    """`Equations` of gain, places and slips; by fault the unknowns that are told and its trials; rows of the slips."""

    equations: Equations
    faults: dict
    slips: list


def _equations(held, unknowns, spread, fixed):
    """`_Made` from `HeldReading` by test; ``fixed``: row of the slip that was named, by test."""
    steps = [_without_lag(_steps(len(one.left)), one) for one in held]
    left, ends = (
        [_without_lag(one.left, one) for one in held],
        np.cumsum([0, *(len(one.left) for one in held)]),
    )
    left, columns = np.concatenate(left), np.zeros((ends[-1], len(spread)))
    rows, of_slips = [slice(*of_test) for of_test in pairwise(ends)], unknowns.numbers[slip.OF_END][:, 0, 0]
    for one, own in zip(held, rows, strict=True):
        for column in _COLUMNS:
            columns[own, unknowns.numbers[column][0, 0]] = _without_lag(column.signature(one), one)
    for test, row in fixed.items():
        columns[rows[test], of_slips[test]] = steps[test][:, row - _EDGE]
    information = columns.T @ columns + _variance(columns, left) * np.diag(1.0 / spread**2)
    rest, slips = left - columns @ np.linalg.solve(information, columns.T @ left), []
    for test, (own, step) in enumerate(zip(rows, steps, strict=True)):
        gained = (step.T @ rest[own]) ** 2 / np.maximum((step**2).sum(axis=0), 1e-12)
        slips.append(fixed.get(test, _EDGE + int(gained.argmax())))
        columns[own, of_slips[test]] = step[:, slips[test] - _EDGE]
    rest, sums = _left_over(columns, left), []
    for own in rows:
        whole = len(rest[own]) // _SEGMENT * _SEGMENT
        sums.append(rest[own][:whole].reshape(-1, _SEGMENT).sum(axis=1))
    variance, sums = _variance(columns, left), np.concatenate(sums)
    slow = max((sums**2).sum() / (variance * len(left)), 1.0)
    normal, freedom = columns.T @ columns, max(len(sums) - columns.shape[1], 4.0)
    equations = Equations(normal, columns.T @ left, variance * slow, freedom)
    seen, faults = max(np.sqrt(variance), *(one.noise for one in held)), {}
    for column in _COLUMNS:
        (fault,) = unknowns.faults(column)
        size = np.sqrt((columns[:, unknowns.of(fault)] ** 2).mean(axis=0))
        if (informed := unknowns.of(fault)[column.visible * size > seen]).size:
            faults[fault] = informed, 1
    for fault in unknowns.faults(slip.OF_END):
        faults[fault] = unknowns.of(fault), steps[fault.test].shape[1]
    return _Made(equations, faults, slips)


def _estimate(own, told, mean, covariance, spread):
    """Estimate and covariance of a fault with all that is named; along what is not told 0, as good as unknown."""
    estimate, square, at = np.zeros(len(own)), np.diag(spread[own] ** 2), told - own[0]
    estimate[at], square[np.ix_(at, at)] = mean[told], covariance[np.ix_(told, told)]
    return estimate, square


def _steps(count):
    """Steps from row `_EDGE` to row ``count - _EDGE``, one a column, without their means."""
    rows = np.arange(_EDGE, count - _EDGE + 1)
    steps = (np.arange(count)[:, None] >= rows).astype(float)
    return steps - steps.mean(axis=0)


def _left_over(columns, left):
    return left - columns @ np.linalg.lstsq(columns, left, rcond=None)[0]


def _variance(columns, left):
    """Of a mean, where all faults are free [m2]."""
    rest = _left_over(columns, left)
    return max((rest**2).sum() / max(len(left) - columns.shape[1], 1), _NOTHING**2)
