"""Gain on the rows of sealed tests: the share of their unexplained forces that the causes explain at frozen sizes."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.answer.cause_rows import cause_rows
from blockshake.diagnosis.answer.explain import likelihoods
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.diagnosis.evidence.slab_motion import slab_motion, slab_turns
from blockshake.diagnosis.nominal.ensemble import DISCREPANCY, EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.verdict.verdict import OF_A_GAIN, Contrast, Gain
from blockshake.effects.registry import EFFECTS
from blockshake.statistics.resampling import limits_of, resampled_weights

_WIDER = (1.0, 3.0, 10.0)  # times the priors of the joints' own errors: a discrepancy without a name
_BLOCK = 0.5  # s, of rows that are drawn together
_DRAWS = 1000
_NOTHING = 1.645  # standard deviations of the floor, within which nothing is to gain
NOTHING = Contrast(estimate=0.0, lower=-1.0, upper=1.0)
NOTHING_TO_GAIN = "nothing to gain on the sealed tests' forces against the {} model: it is within its errors"
NO_ROWS = "no gain was measured on forces: the cause says nothing of those of the sealed tests"


class Squares(NamedTuple):
    """Squared distances of the rows of sealed tests, in units of their covariance.

    ``block`` int array (n_rows,): rows that are drawn together; ``by_kind``: (n_rows,) by kind of the model; ``floor``
    (n_rows,): expected of the extended model if all is true.
    """

    block: np.ndarray
    by_kind: dict
    floor: np.ndarray


def row_gain(decision, opened, sealed):
    """Gain of the causes of a decision on sealed tests.

    Parameters
    ----------
    decision : Decision
    opened, sealed : list of SeenTest

    Returns
    -------
    Gain or None, xarray.Dataset, list of str
        ``distance(kind)``: mean squared distance of the rows, with ``floor`` and number of rows; and caveats.

    Notes
    -----
    The models predict the rows of a sealed test: nominal with the edges and coefficients of sound blocks, recalibrated
    with those that fit the open tests without the cause, extended with those that fit beside it, and a discrepancy
    without a name whose edges and coefficients lie once, three or ten times as far off, as the open tests say. The gain
    is ``(D_rival - D_extended) / (D_rival - D_floor)``; intervals of 90 % by a bootstrap of blocks of 0.5 s. A push
    starts in a sealed test when it fits best: its size is frozen, its start cannot be.
    """
    parts = [*_of_joints(decision, opened, sealed), *_of_slab(decision, opened, sealed)]
    if not parts:
        return None, xr.Dataset(), [NO_ROWS]
    shift = np.cumsum([0, *(part.block.max() + 1 for part in parts[:-1])])
    whole = Squares(
        np.concatenate([part.block + start for part, start in zip(parts, shift, strict=True)]),
        {kind: np.concatenate([part.by_kind[kind] for part in parts]) for kind in parts[0].by_kind},
        np.concatenate([part.floor for part in parts]),
    )
    means = {kind: float(values.mean()) for kind, values in whole.by_kind.items()}
    table = xr.Dataset(
        {"distance": ("kind", list(means.values())), "floor": whole.floor.mean(), "rows": len(whole.block)},
        {"kind": list(means)},
    )
    drawn, least = _drawn(whole), whole.floor.mean() * (1.0 + _NOTHING * np.sqrt(2.0 / len(whole.block)))
    rivals = (RECALIBRATED, NOMINAL, DISCREPANCY)
    idle = [rival for rival in rivals if means[rival] < least]
    contrasts = {rival: NOTHING if rival in idle else _contrast(means, drawn, rival) for rival in rivals}
    return Gain(**contrasts), table, [NOTHING_TO_GAIN.format(rival) for rival in idle]


def _contrast(means, drawn, rival):
    floor = drawn["floor"][0]
    whole = _ratio(means[rival], means[EXTENDED], floor)
    values = _ratio(drawn[rival][1:], drawn[EXTENDED][1:], drawn["floor"][1:])
    lower, upper = limits_of(values, OF_A_GAIN)
    return Contrast(estimate=float(whole), lower=float(min(lower, whole)), upper=float(max(upper, whole)))


def _ratio(rival, extended, floor):
    return np.clip((rival - extended) / np.maximum(rival - floor, 1e-9), -1.0, 1.0)


def _drawn(whole):
    """Means of the whole and of blocks drawn again, by kind and of the floor, (1 + n_draws,)."""
    count = int(whole.block.max()) + 1
    rows = np.bincount(whole.block, minlength=count)
    times = resampled_weights(count, np.random.default_rng([count, len(whole.block)]), _DRAWS)
    total = np.maximum(times @ rows, 1)
    sums = {**whole.by_kind, "floor": whole.floor}
    return {
        name: times @ np.bincount(whole.block, one, minlength=count) / total for name, one in sums.items()
    }


def _of_joints(decision, opened, sealed):
    """`Squares` of the joints' rows; none without a cause that says something of them."""
    causes = [part.causes[0] for part in decision.parts if part.readings.startswith("joints")]
    before = [JointRows(one) for one in opened if len(one.rows.value)]
    after = [JointRows(one) for one in sealed if len(one.rows.value)]
    tests = [*before, *after]
    if not causes or not before or not after:
        return []
    models = likelihoods(tests)
    explained = [cause_rows(cause, before, after, models[0]) for cause in causes]
    if not any(one.says for one in explained):
        return []
    rows = [sum(one.rows[number] for one in explained) for number in range(len(tests))]
    return [_squares(_loudest(models, rows, len(before)), rows, len(before), tests)]


def _loudest(models, rows, n_open):
    """The likelihood that says most for the open tests, the cause's rows taken off."""

    def says(model):
        stop = model.ends[n_open]
        value = (model.value - model.whiten([one[:, None] for one in rows])[:, 0])[:stop]
        spread = sum(np.log(np.diag(root)).sum() for root in model.roots[:n_open])
        return _says(value, model.nuisances[:stop]) - spread + model.prior

    return max(models, key=says)


def _squares(model, rows, n_open, tests):
    stop = model.ends[n_open]
    off = model.whiten([one[:, None] for one in rows])[:, 0]
    seen, further = model.nuisances[:stop], model.nuisances[stop:]
    by_kind, none = {}, np.zeros(len(off))
    unnamed = max(_WIDER, key=lambda wider: _says(model.value[:stop], seen * wider))
    for kind, taken, wider in (
        (EXTENDED, off, 1.0), (RECALIBRATED, none, 1.0), (NOMINAL, none, 0.0), (DISCREPANCY, none, unnamed),
    ):  # fmt: skip
        value = model.value - taken
        fitted = _fitted(value[:stop], seen * wider)
        by_kind[kind] = (value[stop:] - further @ (wider * fitted)) ** 2
    inner = np.linalg.inv(np.eye(seen.shape[1]) + seen.T @ seen)
    floor = 1.0 + np.einsum("ri,ij,rj->r", further, inner, further)
    times = [test.rows.time for test in tests[n_open:]]
    return Squares(_blocks(times), by_kind, floor)


def _fitted(value, nuisances):
    """Amplitudes of nuisances with standard normal priors, at their best."""
    return np.linalg.solve(np.eye(nuisances.shape[1]) + nuisances.T @ nuisances, nuisances.T @ value)


def _says(value, nuisances):
    """Logarithm of the density of whitened rows, up to a constant."""
    left = value @ value - (nuisances.T @ value) @ _fitted(value, nuisances)
    return -0.5 * left - 0.5 * np.linalg.slogdet(np.eye(nuisances.shape[1]) + nuisances.T @ nuisances)[1]


def _blocks(times):
    """Numbers of the blocks of rows, test by test."""
    found, first = [], 0
    for time in times:
        own = ((time - time.min()) / _BLOCK).astype(int)
        found.append(first + own)
        first += own.max() + 1
    return np.unique(np.concatenate(found), return_inverse=True)[1]


def _of_slab(decision, opened, sealed):
    """`Squares` of the slab's rotation, of an effect that turns it."""
    causes = [part.causes[0] for part in decision.parts if part.readings.startswith("rotation of the slab")]
    if not causes or not sealed:
        return []
    (cause,) = causes
    slabs = [slab_motion(one) for one in [*opened, *sealed]]
    variants = [EFFECTS[cause.name].turns(slab) for slab in slabs]
    rows = [next(one.rows for one in own if one.values == cause.when) @ cause.amplitudes for own in variants]
    model = slab_turns(slabs)
    return [_squares(model, rows, len(opened), [_Timed(slab) for slab in slabs])]


class _Timed(NamedTuple):
    """The slab's instants as the rows of a test."""

    slab: object

    @property
    def rows(self):
        return self

    @property
    def time(self):
        return self.slab.time[self.slab.at]
