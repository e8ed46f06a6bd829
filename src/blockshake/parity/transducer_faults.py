"""Faults of a displacement transducer: wrong sign, gain, an end elsewhere, an end that slips, one after the other."""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import Finding, chance_within
from blockshake.parity.posterior import VAGUE, data_alone, posterior
from blockshake.parity.transducer_equations import PLACES

GAIN, PLACE, REFERENCE, SLIP = "gain", "place", "reference place", "slip"
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
_EFFECTS = {GAIN: "sensor-gain", PLACE: "marker-offset", REFERENCE: "marker-offset", SLIP: "sensor-drift"}
_SEGMENT = 5  # means over which coloured noise averages out, half a second
_EDGE = 3  # means before and after a slip
_REVERSED = 0.5  # of the misfit that the other sign may leave at most
_OVER_RIVALS = 9.0  # less in the sum of weighted squares than the best: not told apart
_MOST_FAULTS = 4
_NOTHING = 1e-9  # m and m/s, as of readings without any noise


class TransducerCheck(NamedTuple):
    """Gain, reading over truth less 1, with its standard error [1], NaN where nothing tells it; and the findings."""

    gain: float
    gain_error: float
    findings: tuple


@dataclass(frozen=True)
class _Equations:
    """Normal equations of gain, six places and one slip a test; and the row of each test's likeliest slip.

    ``variance`` is that of a mean [m2], with the factor by which coloured noise averages out more slowly; ``seen`` is
    what a fault has to leave in the means to be looked for [m].
    """

    columns: np.ndarray
    left: np.ndarray
    normal: np.ndarray
    right: np.ndarray
    variance: float
    seen: float
    freedom: float
    slips: tuple


def hypotheses(n_tests):
    """Number of faults that are looked at: sign, gain, two places, and a slip in each test."""
    return 4 + n_tests


def check_transducer(name, held, level, looked_at):
    """`TransducerCheck` of one transducer: the clearest fault first, until the rest is within the tolerances.

    Parameters
    ----------
    name : str
    held : dict of str to HeldReading
        By test; empty where the markers see nothing of it.
    level : float
        Of all hypotheses together.
    looked_at : int
        Number of hypotheses in the campaign.

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
    readings = [_without_lag(one.left, one) for one in held.values()]
    turned = [_without_lag(one.reversed().left, one) for one in held.values()]
    p = looked_at * _chance_of_sign(*(np.concatenate(parts) for parts in (readings, turned)))
    if p < level:
        findings.append(Finding("channel-swap", (name,), "polarity", np.empty(0), np.empty((0, 0)), p, tests))
        held = {test: one.reversed() for test, one in held.items()}
    named, fixed = {}, {}
    while True:
        spread = _spread(named, len(tests))
        equations = _equations(list(held.values()), spread, fixed)
        judged = {
            one: _judge(equations, spread, one)
            for one in _hypotheses(equations, len(tests))
            if one not in named
        }
        clear = {one: found for one, found in judged.items() if found[1] * looked_at < level}
        if not clear or len(named) == _MOST_FAULTS:
            break
        best = max(clear, key=lambda one: clear[one][0])
        near = [one for one in judged if one != best and clear[best][0] - judged[one][0] < _OVER_RIVALS]
        named[best] = clear[best][1] * looked_at, tuple((_EFFECTS[kind], (name,), kind) for kind, _ in near)
        if best[0] == SLIP:
            fixed[best[1]] = equations.slips[best[1]]
    for one, (p, rivals) in named.items():
        findings.append(_finding(name, one, equations, spread, tests, list(held.values()), p, rivals))
    gain, error = np.nan, np.nan
    if _informed(equations, GAIN).any():
        mean, covariance = posterior(equations, spread)
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


def _places(kind, test=0):
    first = {GAIN: 0, PLACE: 1, REFERENCE: 4, SLIP: 1 + PLACES + test}[kind]
    return first + np.arange(1 if kind in (GAIN, SLIP) else 3)


def _spread(named, n_tests):
    """Standard deviation of each unknown before anything is read; as good as unknown where it was named."""
    halves = (
        [_TOLERANCE[GAIN]]
        + 3 * [_TOLERANCE[PLACE]]
        + 3 * [_TOLERANCE[REFERENCE]]
        + n_tests * [_TOLERANCE[SLIP]]
    )
    spread = np.array(halves) / 2.0
    for kind, test in named:
        spread[_places(kind, test)] *= VAGUE
    return spread


def _equations(held, spread, fixed):
    """`_Equations`; ``fixed``: row of the slip that was named, by test."""
    n_tests, blocks, lefts = len(held), [], []
    for place, one in enumerate(held):
        block = np.zeros((len(one.left), 1 + PLACES + n_tests))
        block[:, 0], block[:, 1 : 1 + PLACES] = one.expected, one.places
        if place in fixed:
            block[:, 1 + PLACES + place] = _steps(len(one.left))[:, fixed[place] - _EDGE]
        blocks.append(_without_lag(block, one))
        lefts.append(_without_lag(one.left, one))
    columns, left = np.concatenate(blocks), np.concatenate(lefts)
    begin, slips = np.cumsum([0, *map(len, lefts)]), []
    information = columns.T @ columns + _variance(columns, left) * np.diag(1.0 / spread**2)
    rest = left - columns @ np.linalg.solve(information, columns.T @ left)
    for place, one in enumerate(held):
        steps = _without_lag(_steps(len(one.left)), one)
        gained = (steps.T @ rest[begin[place] : begin[place + 1]]) ** 2 / np.maximum(
            (steps**2).sum(axis=0), 1e-12
        )
        row = fixed.get(place, _EDGE + int(gained.argmax()))
        columns[begin[place] : begin[place + 1], 1 + PLACES + place] = steps[:, row - _EDGE]
        slips.append(row)
    variance, segments = _variance(columns, left), _segments(columns, left, begin)
    slow = max((segments**2).sum() / (variance * len(left)), 1.0)
    return _Equations(
        columns, left, columns.T @ columns, columns.T @ left, variance * slow,
        max(np.sqrt(variance), *(one.noise for one in held)), max(len(segments) - columns.shape[1], 4.0), tuple(slips),
    )  # fmt: skip


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


def _segments(columns, left, begin):
    """Sums of what is left over half-second segments [m], of all tests."""
    rest, sums = _left_over(columns, left), []
    for first, last in pairwise(begin):
        whole = (last - first) // _SEGMENT * _SEGMENT
        sums.append(rest[first : first + whole].reshape(-1, _SEGMENT).sum(axis=1))
    return np.concatenate(sums)


def _informed(equations, kind):
    """Columns of a kind in which its visible fault would leave as much as the noise."""
    own = equations.columns[:, _places(kind)]
    return _VISIBLE[kind] * np.sqrt((own**2).mean(axis=0)) > equations.seen


def _hypotheses(equations, n_tests):
    constant = [(kind, 0) for kind in (GAIN, PLACE, REFERENCE) if _informed(equations, kind).any()]
    return constant + [(SLIP, test) for test in range(n_tests)]


def _own(equations, kind, test):
    """Unknowns of a hypothesis that the readings tell something about."""
    place = _places(kind, test)
    return place if kind == SLIP else place[_informed(equations, kind)]


def _judge(equations, spread, hypothesis):
    """Gain in the sum of squares less twice the unknowns, and the chance of a sound sensor."""
    kind, test = hypothesis
    place = _own(equations, kind, test)
    mean, covariance = posterior(equations, spread)
    estimate, own = data_alone(mean[place], covariance[np.ix_(place, place)], spread[place])
    tied = own + np.diag(spread[place] ** 2)
    gained = estimate @ np.linalg.solve(tied, estimate) - 2.0 * len(place)
    tried = (equations.columns[:, place[0]] != 0.0).sum() if kind == SLIP else 1
    return gained, tried * chance_within(estimate, own, _TOLERANCE[kind], equations.freedom)


def _finding(name, hypothesis, equations, spread, tests, held, p, rivals):
    """The finding, its estimate as it is with all that is named; along what is not seen 0, as good as unknown."""
    kind, test = hypothesis
    place, own = _places(kind, test), _own(equations, kind, test)
    mean, covariance = posterior(equations, spread)
    estimate, square = np.zeros(len(place)), np.diag(spread[place] ** 2)
    at = own - place[0]
    estimate[at], square[np.ix_(at, at)] = mean[own], covariance[np.ix_(own, own)]
    if kind == SLIP:
        time = held[test].time
        row = equations.slips[test]
        estimate = np.array([estimate[0], 0.5 * (time[row - 1] + time[row])])
        square = np.diag([square[0, 0], (time[row] - time[row - 1]) ** 2 / 12.0])
    at_tests = (tests[test],) if kind == SLIP else tests
    return Finding(_EFFECTS[kind], (name,), kind, estimate, square, p, at_tests, rivals)
