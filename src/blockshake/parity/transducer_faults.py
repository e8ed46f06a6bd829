"""Faults of a displacement transducer: wrong sign, gain, an end elsewhere, an end that slips, one after the other."""

from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import chance_of_misfit
from blockshake.parity.kinds import drift, gain, wrong_place
from blockshake.parity.kinds.channel_swap import POLARITY
from blockshake.parity.linear_faults import (
    Equations,
    Unknowns,
    coloured_variance,
    data_alone,
    name_faults,
)

_COLUMNS = gain.OF_TRANSDUCER, wrong_place.OF_END, wrong_place.OF_REFERENCE_END
_SEGMENT = 5  # means over which coloured noise averages out, half a second
_EDGE = 3  # means before and after a slip
_MOST_FAULTS = 4
_NOTHING = 1e-9  # m and m/s, as of readings without any noise


class TransducerCheck(NamedTuple):
    """Findings, and the gain: reading over truth less 1, with its standard error [1]; NaN where it is not known."""

    gain: float
    gain_error: float
    findings: tuple


def hypotheses(n_tests):
    """Number of faults that are looked at: sign, gain, two places, and a slip in each test."""
    return 4 + n_tests


def check_transducer(name, held, level):
    """`TransducerCheck`: name the faults of one transducer, the clearest first, until the rest is within tolerances.

    Parameters
    ----------
    name : str
    held : dict of str to HeldReading
        By test; empty where the markers do not see the transducer's ends.
    level : Level

    Notes
    -----
    What remains of the means of a test is ``c + g e + J d + s H + l r`` with constant c, gain g of the expectation e,
    wrong places d of both ends, a slip s from some time on, and a lag l of the rate r. Constants and lags are taken
    out; the other unknowns are tied to zero by half their tolerance, but for those that have been named. The time of a
    slip is the most probable one, and its chance counts once for each time that was tried.

    A gain or a place is looked for only where a visible one would leave as much as the noise of a mean: noise in a
    column makes its coefficient too small, of a gain by less than the square of this, a tenth of its tolerance.
    """
    tests, findings = tuple(held), []
    if not held:
        return TransducerCheck(np.nan, np.nan, ())
    readings, turned = (
        np.concatenate([_without_lag(means.misfit, means) for means in whole])
        for whole in (held.values(), [means.reversed() for means in held.values()])
    )
    after = (turned**2).sum()
    chance = chance_of_misfit((readings**2).sum(), after, max(after / len(turned), _NOTHING**2))
    if level.hypotheses * chance < level.chance:
        findings.append(POLARITY.finding((name,), level.hypotheses * chance, tests))
        held = {test: means.reversed() for test, means in held.items()}
    unknowns, rows = Unknowns((*_COLUMNS, drift.OF_END), 1, len(tests)), {}

    def equations_of(named, spread):
        fixed = {fault.test: rows[fault.test] for fault in named if fault.column is drift.OF_END}
        equations, most_probable = _equations(list(held.values()), unknowns, spread, fixed)
        rows.update(most_probable)
        return equations

    named, equations, spread = name_faults(equations_of, unknowns, level, (name,), _MOST_FAULTS)
    mean, covariance = equations.posterior(spread)
    for fault, p in named.items():
        numbers, where = unknowns.of(fault), tests
        # along what is unknown 0, as good as unknown
        estimate, square = np.zeros(len(numbers)), np.diag(spread[numbers] ** 2)
        informed, _ = equations.faults[fault]
        at = informed - numbers[0]
        estimate[at], square[np.ix_(at, at)] = mean[informed], covariance[np.ix_(informed, informed)]
        if fault.column is drift.OF_END:
            where = (tests[fault.test],)
            before, after = held[where[0]].time[rows[fault.test] - 1 : rows[fault.test] + 1]
            estimate = np.array([estimate[0], 0.5 * (before + after)])
            square = np.diag([square[0, 0], (after - before) ** 2 / 12.0])
        findings.append(fault.column.kind.finding((name,), p, where, estimate, square))
    (of_gain,) = unknowns.faults(gain.OF_TRANSDUCER)
    if of_gain not in equations.faults:
        return TransducerCheck(np.nan, np.nan, tuple(findings))
    size, error = data_alone(mean[:1], covariance[:1, :1], spread[:1])
    return TransducerCheck(float(size[0]), float(np.sqrt(error[0, 0])), tuple(findings))


def _without_lag(values, held):
    """Take out of means (n_means, ...) the part that a lag of the clocks explains."""
    late = held.late / max(np.linalg.norm(held.late), _NOTHING)
    return values - np.multiply.outer(late, late @ values)


def _equations(held, unknowns, spread, fixed):
    """`Equations` from `HeldReading` by test, and the row of each test's most probable slip; ``fixed``: of named
    ones."""
    misfits = [_without_lag(means.misfit, means) for means in held]
    steps = [_without_lag(_steps(len(means.misfit)), means) for means in held]
    of_slips, rows = unknowns.numbers[drift.OF_END][:, 0, 0], dict(fixed)
    blocks = [np.zeros((len(means.misfit), len(spread))) for means in held]
    for test, (block, means) in enumerate(zip(blocks, held, strict=True)):
        for column in _COLUMNS:
            block[:, unknowns.numbers[column][0, 0]] = _without_lag(column.signature(means), means)
        if test in fixed:
            block[:, of_slips[test]] = steps[test][:, fixed[test] - _EDGE]
    _, white, _ = _left_over(blocks, misfits)
    columns = np.concatenate(blocks)
    information = columns.T @ columns + white * np.diag(1.0 / spread**2)
    sizes = np.linalg.solve(information, columns.T @ np.concatenate(misfits))
    for test, (block, step) in enumerate(zip(blocks, steps, strict=True)):
        gained = (step.T @ (misfits[test] - block @ sizes)) ** 2 / np.maximum((step**2).sum(axis=0), 1e-12)
        rows.setdefault(test, _EDGE + int(gained.argmax()))
        block[:, of_slips[test]] = step[:, rows[test] - _EDGE]
    rest, white, freedom = _left_over(blocks, misfits)
    variance = np.fmax(coloured_variance(rest, freedom, _SEGMENT), _NOTHING**2)
    columns, faults = np.concatenate(blocks), {}
    visible = max(np.sqrt(white), *(means.noise for means in held))
    for column in _COLUMNS:
        (fault,) = unknowns.faults(column)
        size = np.sqrt((columns[:, unknowns.of(fault)] ** 2).mean(axis=0))
        if (informed := unknowns.of(fault)[column.visible * size > visible]).size:
            faults[fault] = informed, 1
    for fault in unknowns.faults(drift.OF_END):
        faults[fault] = unknowns.of(fault), steps[fault.test].shape[1]
    segments = sum(len(means) // _SEGMENT for means in misfits)
    right, freedom = columns.T @ np.concatenate(misfits), max(segments - columns.shape[1], 4.0)
    return Equations(columns.T @ columns, right, variance, faults, freedom), rows


def _steps(count):
    """Steps from row `_EDGE` to row ``count - _EDGE``, one a column, without their means."""
    rows = np.arange(_EDGE, count - _EDGE + 1)
    steps = (np.arange(count)[:, None] >= rows).astype(float)
    return steps - steps.mean(axis=0)


def _left_over(blocks, misfits):
    """Rest of each test's means (n_means, 1) where all faults are free [m], its variance, and its freedom."""
    columns, means = np.concatenate(blocks), np.concatenate(misfits)
    rest = means - columns @ np.linalg.lstsq(columns, means, rcond=None)[0]
    freedom = max(len(rest) - columns.shape[1], 1)
    parts = np.split(rest[:, None], np.cumsum([len(means) for means in misfits])[:-1])
    return parts, max((rest**2).sum() / freedom, _NOTHING**2), freedom
