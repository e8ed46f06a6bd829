"""Evidence of causes in free flights: what Newton's second law leaves of the paths."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.diagnosis.evidence.likelihood import Likelihood, from_rows
from blockshake_flight.arcs import noise_of
from blockshake_flight.causes import CAUSES, air_drag, nuisances
from blockshake_flight.paths import dragged_by_square, fallen, off_centre

_INDEPENDENT = 3.0  # numbers that a flight and axis tell, if what its readings leave is smooth and no noise
_ROUNDS = 4  # of weighing the flights
# at most so many blocks of at least so many tests, and the fewest that tell a scatter: a frame errs by day
_BLOCKS, _TESTS_EACH, _FEWEST_BLOCKS = 10, 4, 3


@dataclass(frozen=True)
class FlightRows:
    """Rows of all flights, a block for each flight and filmed axis, and their likelihood."""

    tracked: object  # PosedCampaign
    arcs: list  # of Arc
    values: list  # of float64 array, shape (n_rows,); positions less a free fall in air [m]
    noise: float  # of a coordinate [m]
    likelihood: Likelihood

    def columns(self, paths):
        """Rows of paths, a callable of an `Arc` to (n, k, 3): list of float64 array, shape (n_rows, k)."""
        return _blocks(self.arcs, paths)

    def of_cause(self, cause):
        """Rows of a `FlightCause` at sizes 1: list of float64 array, shape (n_rows, n_sizes)."""
        return self.columns(lambda arc: cause.paths(arc, self.tracked))

    def given(self, fit, share):
        """The rows with a cause among the nuisances, whose form may leave a share of the path that it makes."""
        columns = self.of_cause(fit.cause)
        errors = [share**2 * np.outer(column @ fit.sizes, column @ fit.sizes) for column in columns]
        scales = np.full(len(fit.sizes), fit.cause.scale(self.tracked))
        wide = self.likelihood.given(columns, scales, errors)
        return FlightRows(self.tracked, self.arcs, self.values, self.noise, wide)

    def refitted(self, fit, others):
        """A fit given other fits, all sizes free together; its gain stays."""
        rows = self
        for other in others:
            rows = rows.given(other, 0.0)
        again = explain(rows, fit.cause)
        return FlightFit(fit.cause, fit.gain, again.sizes, again.covariance)

    def of_tests(self, names):
        """The rows of the flights of some tests alone, given by their names."""
        kept = [arc.test in names for arc in self.arcs]
        blocks = np.flatnonzero(np.repeat(kept, [len(arc.axes) for arc in self.arcs]))
        arcs = [arc for arc, own in zip(self.arcs, kept, strict=True) if own]
        likelihood = self.likelihood.of_tests(blocks) if arcs else None
        return FlightRows(self.tracked, arcs, [self.values[n] for n in blocks], self.noise, likelihood)


@dataclass(frozen=True)
class FlightFit:
    """A cause next to the rows."""

    cause: object  # FlightCause
    gain: float  # logarithm of its evidence over that of none
    sizes: np.ndarray  # float64 (n_sizes,); the most probable ones
    covariance: np.ndarray  # float64 (n_sizes, n_sizes)

    def with_variance(self, more):
        """The fit with further variances of its sizes, (n_sizes,)."""
        return replace(self, covariance=self.covariance + np.diag(more))

    @property
    def size(self):
        """Length of all sizes together."""
        return float(np.linalg.norm(self.sizes))


def flight_rows(tracked, arcs):
    """`FlightRows` of the flights of a campaign.

    Notes
    -----
    What all causes together leave of a flight beyond white noise is smooth: errors of the tracking that turn with the
    body, a touch of a guide. That rest therefore counts as three independent readings a flight and axis, at least of
    the usual size, so that flights that something else disturbs are worth less, for all causes alike.
    """
    noise, values = noise_of(arcs), [left[:, 0] for left in _blocks(arcs, lambda arc: _left(arc, tracked))]
    small = _blocks(arcs, lambda arc: nuisances(arc, tracked))
    whole = _blocks(
        arcs,
        lambda arc: np.concatenate(
            [
                nuisances(arc, tracked),
                *(cause.scale(tracked) * cause.paths(arc, tracked) for cause in CAUSES),
            ],
            axis=1,
        ),
    )
    variances = np.full(len(values), noise**2)
    for _ in range(_ROUNDS):
        variances = _variances_given(values, whole, variances, noise)
    covariances = [variance * np.eye(len(value)) for variance, value in zip(variances, values, strict=True)]
    by_nuisance = [[rows[:, number] for rows in small] for number in range(small[0].shape[1])]
    return FlightRows(tracked, arcs, values, noise, from_rows(covariances, values, by_nuisance))


def _left(arc, tracked):
    """Path less that of the mass centre in air, (n, 1, 3) [m]."""
    file = tracked.structure.file
    offset = np.array(file.bodies[tracked.body].mass_offset)
    known = fallen(arc, file.gravity) + air_drag(tracked) * dragged_by_square(arc)[:, 0]
    return (arc.position - known - np.einsum("nkx,k->nx", off_centre(arc), offset))[:, None]


def _blocks(arcs, paths):
    """Rows of paths, a callable of an `Arc` to (n, k, 3): an array (n_rows, k) for each flight and filmed axis."""
    return [rows[:, :, axis] for arc in arcs for rows in [arc.free(paths(arc))] for axis in arc.axes]


def _variances_given(values, columns, variances, noise):
    """Variances of a reading in each block, (n_blocks,), given columns of standard normal amplitudes at their best."""
    precision, target = np.eye(columns[0].shape[1]), np.zeros(columns[0].shape[1])
    for value, rows, variance in zip(values, columns, variances, strict=True):
        precision += rows.T @ rows / variance
        target += rows.T @ value / variance
    amplitudes = np.linalg.solve(precision, target)
    left = np.array([
        np.mean((value - rows @ amplitudes) ** 2) for value, rows in zip(values, columns, strict=True)
    ])  # fmt: skip
    count = np.array([len(value) for value in values])
    # what white noise alone leaves, with its own scatter, is no smooth rest
    smooth = np.maximum(
        np.maximum(left, np.median(left)) - noise**2 * (1.0 + 2.0 * np.sqrt(2.0 / count)), 0.0
    )
    return noise**2 + smooth * count / _INDEPENDENT


def explain(rows, cause):
    """`FlightFit` of a `FlightCause`."""
    columns = rows.of_cause(cause)
    scales = np.full(columns[0].shape[1], cause.scale(rows.tracked))
    fit = rows.likelihood.amplitudes(rows.likelihood.whiten(columns), scales, cause.positive)
    return FlightFit(cause, fit.gain, fit.mean, fit.covariance)


def explained_share(rows, fits):
    """Share of the squared distance beyond the noise that causes at their best sizes take off all flights [1]."""
    before = np.concatenate(rows.values)
    taken = sum(np.concatenate(rows.of_cause(fit.cause)) @ fit.sizes for fit in fits)
    floor = rows.noise**2 * len(before)
    left = before - taken
    return float(1.0 - (left @ left - floor) / (before @ before - floor))


def blocks_of(names):
    """Names of tests in blocks of one after the other, a list of list of str; empty of too few tests."""
    count = min(_BLOCKS, len(names) // _TESTS_EACH)
    return [list(block) for block in np.array_split(names, count)] if count >= _FEWEST_BLOCKS else []


def more_variance(sizes, variances):
    """Variance that the scatter between blocks adds to a mean weighted by the inverse variances, (n_sizes,).

    Parameters
    ----------
    sizes, variances : float64 arrays, shape (n_blocks, n_sizes)
        By block, each fitted alone.

    Notes
    -----
    With the weights ``w = 1 / v`` and ``Q = sum w (x - mean)^2``, the variance between n blocks is ``max(0, (Q - n + 1)
    / (sum w - sum w^2 / sum w))`` (DerSimonian and Laird 1986, Controlled Clinical Trials 7, Eq. 8). A frame's error
    prefers no axis: it is at least that of all sizes of the cause, numerators and denominators summed. The weighted
    mean has ``sum w^2 / (sum w)^2`` of it.
    """
    weights = 1.0 / variances
    total, squares = weights.sum(axis=0), (weights**2).sum(axis=0)
    mean = (weights * sizes).sum(axis=0) / total
    excess = (weights * (sizes - mean) ** 2).sum(axis=0) - len(sizes) + 1.0
    per_variance = total - squares / total
    between = np.maximum(excess / per_variance, max(excess.sum(), 0.0) / per_variance.sum())
    return between * squares / total**2


def widened(rows, fit, others):
    """A `FlightFit` given others, its covariance with the scatter of its sizes between blocks of tests."""
    again = []
    for names in blocks_of([test.name for test in rows.tracked.tests]):
        block = rows.of_tests(names)
        if block.arcs:
            again.append(block.refitted(fit, others))
    if len(again) < _FEWEST_BLOCKS:
        return fit
    more = more_variance(
        np.array([one.sizes for one in again]), np.array([np.diag(one.covariance) for one in again])
    )
    return fit.with_variance(more)
