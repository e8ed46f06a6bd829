"""Faults of a displacement transducer: wrong sign, gain, an end elsewhere, an end that slips, one after the other."""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import Finding
from blockshake.parity.linear_faults import Fault, clearest, data_alone, freed, judge, posterior

GAIN, PLACE, REFERENCE, SLIP = "gain", "place", "reference place", "slip"
_COLUMNS = {GAIN: np.arange(1), PLACE: np.arange(1, 4), REFERENCE: np.arange(4, 7)}
_FIRST_SLIP = 7  # column of the first test's slip
# What a sound transducer may have; its standard deviation is half of it.
_TOLERANCE = {
    GAIN: 1e-2,  # of a calibration, as that of an accelerometer
    PLACE: 5e-3,  # m, along any direction; hooks and brackets are placed with a tape
    REFERENCE: 5e-3,
    SLIP: 5e-4,  # m, of a hook or a bracket that beds in
}
# Faults that are looked for only where they would leave as much as the noise of a mean: noise in a column makes its
# coefficient too small, of a gain by less than the square of this, a tenth of its tolerance.
_VISIBLE = {GAIN: 0.03, PLACE: 0.05, REFERENCE: 0.05}  # 1, m, m; those of markers in the registry
_SEGMENT = 5  # means over which coloured noise averages out, half a second
_EDGE = 3  # means before and after a slip
_REVERSED = 0.5  # of the misfit that the other sign may leave at most
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
    """
    tests, findings = tuple(held), []
    if not held:
        return TransducerCheck(np.nan, np.nan, ())
    readings, turned = (
        np.concatenate([_without_lag(one.left, one) for one in whole])
        for whole in (held.values(), [one.reversed() for one in held.values()])
    )
    p = level.hypotheses * _chance_of_sign(readings, turned)
    if p < level.chance:
        findings.append(Finding.of("polarity", (name,), p, tests))
        held = {test: one.reversed() for test, one in held.items()}
    named, slips = {}, {}
    while True:
        spread = freed(_spread(len(tests)), map(_columns, named))
        equations = _Equations.of(list(held.values()), spread, slips)
        judged = judge(equations, spread, equations.open_to(named), level, equations.freedom)
        best = clearest(judged, level, (name,))
        if best is None or len(named) == _MOST_FAULTS:
            break
        named[best[0]] = best[1:]
        if best[0].quantity == SLIP:
            slips[best[0].test] = equations.slips[best[0].test]
    mean, covariance = posterior(equations, spread)
    for fault, (p, rivals) in named.items():
        estimate, square = equations.estimate(fault, mean, covariance, spread)
        at = tests
        if fault.quantity == SLIP:
            at, row = (tests[fault.test],), slips[fault.test]
            before, after = held[at[0]].time[row - 1 : row + 1]
            estimate = np.array([estimate[0], 0.5 * (before + after)])
            square = np.diag([square[0, 0], (after - before) ** 2 / 12.0])
        findings.append(Finding.of(fault.quantity, (name,), p, at, estimate, square, rivals))
    gain, error = np.nan, np.nan
    if equations.informed(GAIN).any():
        alone = data_alone(mean[:1], covariance[:1, :1], spread[:1])
        gain, error = float(alone[0][0]), float(np.sqrt(alone[1][0, 0]))
    return TransducerCheck(gain, error, tuple(findings))


def _chance_of_sign(left, turned):
    """Chance of misfits as these where the sign is right."""
    own, other = (left**2).sum(), (turned**2).sum()
    if other > _REVERSED * own:
        return 1.0
    return float(np.exp(-(own - other) / (2.0 * max(other / len(left), _NOTHING**2))))


def _without_lag(values, held):
    """Means (n_means, ...) without what a lag of the clocks leaves in them."""
    late = held.late / max(np.linalg.norm(held.late), _NOTHING)
    return values - np.multiply.outer(late, late @ values)


def _columns(fault):
    """Unknowns of a fault."""
    return np.array([_FIRST_SLIP + fault.test]) if fault.quantity == SLIP else _COLUMNS[fault.quantity]


def _spread(n_tests):
    """Standard deviation of each unknown before anything is read."""
    kinds = [GAIN, *3 * [PLACE], *3 * [REFERENCE], *n_tests * [SLIP]]
    return np.array([_TOLERANCE[kind] for kind in kinds]) / 2.0


@dataclass(frozen=True)
class _Equations:
    """Normal equations of gain, six places and one slip a test; and the row of each test's likeliest slip.

    ``variance`` is that of a mean [m2], with the factor by which coloured noise averages out more slowly; ``seen`` is
    what a fault has to leave in the means to be looked for [m].
    """

    columns: np.ndarray
    left: np.ndarray
    variance: float
    seen: float
    freedom: float
    slips: tuple

    @classmethod
    def of(cls, held, spread, fixed):
        """Equations of `HeldReading` by test; ``fixed``: row of the slip that was named, by test."""
        blocks = [np.zeros((len(one.left), len(spread))) for one in held]
        for test, (block, one) in enumerate(zip(blocks, held, strict=True)):
            block[:, 0], block[:, 1:_FIRST_SLIP] = one.expected, one.places
            if test in fixed:
                block[:, _FIRST_SLIP + test] = _steps(len(one.left))[:, fixed[test] - _EDGE]
        blocks = [_without_lag(block, one) for block, one in zip(blocks, held, strict=True)]
        left = np.concatenate([_without_lag(one.left, one) for one in held])
        columns, ends = np.concatenate(blocks), np.cumsum([0, *map(len, blocks)])
        information = columns.T @ columns + _variance(columns, left) * np.diag(1.0 / spread**2)
        rest, slips = left - columns @ np.linalg.solve(information, columns.T @ left), []
        for test, one in enumerate(held):
            rows, steps = slice(*ends[test : test + 2]), _without_lag(_steps(len(one.left)), one)
            gained = (steps.T @ rest[rows]) ** 2 / np.maximum((steps**2).sum(axis=0), 1e-12)
            slips.append(fixed.get(test, _EDGE + int(gained.argmax())))
            columns[rows, _FIRST_SLIP + test] = steps[:, slips[test] - _EDGE]
        variance, segments = _variance(columns, left), _segments(columns, left, ends)
        slow = max((segments**2).sum() / (variance * len(left)), 1.0)
        seen = max(np.sqrt(variance), *(one.noise for one in held))
        return cls(
            columns, left, variance * slow, seen, max(len(segments) - columns.shape[1], 4.0), tuple(slips)
        )

    @property
    def normal(self):
        """Products of the columns."""
        return self.columns.T @ self.columns

    @property
    def right(self):
        """Products of the columns with what is left."""
        return self.columns.T @ self.left

    def informed(self, quantity):
        """Columns of a kind in which its visible fault would leave as much as the noise."""
        size = np.sqrt((self.columns[:, _COLUMNS[quantity]] ** 2).mean(axis=0))
        return _VISIBLE[quantity] * size > self.seen

    def read(self, fault):
        """Unknowns of a fault that the readings tell something about."""
        return _columns(fault) if fault.quantity == SLIP else _columns(fault)[self.informed(fault.quantity)]

    def open_to(self, named):
        """Faults that are not named and leave something, as `judge` takes them."""
        faults = [Fault(kind, 0) for kind in _COLUMNS] + [
            Fault(SLIP, 0, test) for test in range(len(self.slips))
        ]
        return {
            fault: (self.read(fault), _TOLERANCE[fault.quantity], self._trials(fault))
            for fault in faults
            if fault not in named and len(self.read(fault))
        }

    def _trials(self, fault):
        """Times at which a slip was tried; 1 for other faults."""
        return (self.columns[:, _FIRST_SLIP + fault.test] != 0.0).sum() if fault.quantity == SLIP else 1

    def estimate(self, fault, mean, covariance, spread):
        """Estimate and covariance of a fault with all that is named; along what is not seen 0, as good as unknown."""
        columns, read = _columns(fault), self.read(fault)
        estimate, square = np.zeros(len(columns)), np.diag(spread[columns] ** 2)
        at = read - columns[0]
        estimate[at], square[np.ix_(at, at)] = mean[read], covariance[np.ix_(read, read)]
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


def _segments(columns, left, ends):
    """Sums of what is left over half-second segments [m], of all tests."""
    rest, sums = _left_over(columns, left), []
    for first, last in pairwise(ends):
        whole = (last - first) // _SEGMENT * _SEGMENT
        sums.append(rest[first : first + whole].reshape(-1, _SEGMENT).sum(axis=1))
    return np.concatenate(sums)
