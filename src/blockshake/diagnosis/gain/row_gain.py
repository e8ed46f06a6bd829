"""Gain on the rows of sealed tests: the share of their unexplained forces that the causes explain at frozen sizes."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.answer.explain import likelihoods
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.diagnosis.evidence.nuisances import nuisances_of, possible
from blockshake.diagnosis.evidence.slab_motion import slab_motion, slab_turns
from blockshake.diagnosis.nominal.ensemble import DISCREPANCY, EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.outside.push import start_of_push
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.verdict.verdict import NOTHING_TO_GAIN, OF_A_GAIN, Contrast, Gain
from blockshake.effects.registry import EFFECTS
from blockshake.statistics.resampling import limits_of, resampled_weights

_WIDER = (1.0, 3.0, 10.0)  # times the priors of the joints' own errors: a discrepancy without a name
_BLOCK = 0.5  # s, of rows that are drawn together
_DRAWS = 1000
_NOTHING = 1.645  # standard deviations of the floor, within which nothing is to gain
_IDLE = "nothing to gain on the sealed tests' forces against the {} model: it is within its errors"
NO_ROWS = "no gain was measured on forces: the cause predicts nothing of those of the sealed tests"


class Squares(NamedTuple):
    """Squared distances of the rows of sealed tests, in units of their covariance.

    ``block`` int array (n_rows,): rows that are drawn together; ``by_kind``: (n_rows,) by kind of the model; ``floor``
    (n_rows,): expected of the extended model if all is true.
    """

    block: np.ndarray
    by_kind: dict
    floor: np.ndarray


def row_gain(decision, opened, sealed):
    """`Gain` of the causes of a `Decision` on sealed tests, or None; and caveats. Tests are lists of
    `ReconstructedTest`.

    Notes
    -----
    The models predict the rows of a sealed test: nominal with the edges and coefficients of undamaged blocks,
    recalibrated with those that fit the open tests without the cause, extended with those that fit with it, and a
    discrepancy without a name whose edges and coefficients lie once, three or ten times as far off, as the open tests
    say. The gain is ``(D_rival - D_extended) / (D_rival - D_floor)``, of mean squared distances D; intervals of 90 % by
    a bootstrap of blocks of 0.5 s. A push starts in a sealed test when it fits best: its size is frozen, its start
    cannot be.
    """
    parts = [*_of_joints(decision, opened, sealed), *_of_slab(decision, opened, sealed)]
    if not parts:
        return None, [NO_ROWS]
    shift = np.cumsum([0, *(part.block.max() + 1 for part in parts[:-1])])
    whole = Squares(
        np.concatenate([part.block + start for part, start in zip(parts, shift, strict=True)]),
        {kind: np.concatenate([part.by_kind[kind] for part in parts]) for kind in parts[0].by_kind},
        np.concatenate([part.floor for part in parts]),
    )
    drawn, least = _drawn(whole), whole.floor.mean() * (1.0 + _NOTHING * np.sqrt(2.0 / len(whole.block)))
    contrasts, caveats = {}, []
    for rival in (RECALIBRATED, NOMINAL, DISCREPANCY):
        mean = float(whole.by_kind[rival].mean())
        if mean < least:
            contrasts[rival] = NOTHING_TO_GAIN
            caveats.append(_IDLE.format(rival))
        else:
            gains = _ratio(drawn[rival][1:], drawn[EXTENDED][1:], drawn["floor"][1:])
            gain = _ratio(mean, float(whole.by_kind[EXTENDED].mean()), drawn["floor"][0])
            contrasts[rival] = Contrast.cut_off(gain, *limits_of(gains, OF_A_GAIN))
    return Gain(**contrasts), caveats


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
    """`Squares` of the joints' rows; none without a cause that constrains them."""
    causes = [part.causes[0] for part in decision.parts if part.readings.startswith("joints")]
    before = [JointRows(one) for one in opened if len(one.rows.value)]
    after = [JointRows(one) for one in sealed if len(one.rows.value)]
    tests = [*before, *after]
    if not causes or not before or not after:
        return []
    nuisances = nuisances_of(tests)
    models = likelihoods(tests, nuisances)
    explained = [cause_rows(cause, before, after, models[0]) for cause in causes]
    explained = [rows for rows in explained if rows is not None]
    if not explained:
        return []
    rows = [sum(of_test) for of_test in zip(*explained, strict=True)]
    times = [test.rows.time for test in after]
    model = _most_probable(models, rows, len(before))
    # given the cause and without it, or a recalibrated model would have masses that no block has
    fits = [_fitted(*_open_rows(model, taken, len(before))) for taken in (rows, [0.0 * one for one in rows])]
    left = possible(nuisances, np.abs(fits).max(axis=0))
    if len(left) < len(nuisances):
        model = _most_probable(likelihoods(tests, left), rows, len(before))
    return [_squares(model, rows, len(before), times)]


def _open_rows(model, rows, n_open):
    """Whitened rows of the open tests, the cause's taken off, and their nuisances."""
    stop = model.ends[n_open]
    return (model.value - model.whiten([one[:, None] for one in rows])[:, 0])[:stop], model.nuisances[:stop]


def _most_probable(models, rows, n_open):
    """Noise model with the largest evidence in the open tests, the cause's rows taken off."""

    def log_evidence(model):
        spread = sum(np.log(np.diag(root)).sum() for root in model.roots[:n_open])
        return _log_evidence(*_open_rows(model, rows, n_open)) - spread + model.prior

    return max(models, key=log_evidence)


def _squares(model, rows, n_open, times):
    """`Squares` of the sealed tests, whose rows are at some times."""
    stop = model.ends[n_open]
    off = model.whiten([one[:, None] for one in rows])[:, 0]
    seen, further = model.nuisances[:stop], model.nuisances[stop:]
    by_kind, none = {}, np.zeros(len(off))
    unnamed = max(_WIDER, key=lambda wider: _log_evidence(model.value[:stop], seen * wider))
    for kind, taken, wider in (
        (EXTENDED, off, 1.0), (RECALIBRATED, none, 1.0), (NOMINAL, none, 0.0), (DISCREPANCY, none, unnamed),
    ):  # fmt: skip
        value = model.value - taken
        fitted = _fitted(value[:stop], seen * wider)
        by_kind[kind] = (value[stop:] - further @ (wider * fitted)) ** 2
    inner = np.linalg.inv(np.eye(seen.shape[1]) + seen.T @ seen)
    floor = 1.0 + np.einsum("ri,ij,rj->r", further, inner, further)
    return Squares(_blocks(times), by_kind, floor)


def _fitted(value, nuisances):
    """Amplitudes of nuisances with standard normal priors, at their best."""
    return np.linalg.solve(np.eye(nuisances.shape[1]) + nuisances.T @ nuisances, nuisances.T @ value)


def _log_evidence(value, nuisances):
    """Logarithm of the density of whitened rows, up to a constant."""
    misfit = value @ value - (nuisances.T @ value) @ _fitted(value, nuisances)
    return -0.5 * misfit - 0.5 * np.linalg.slogdet(np.eye(nuisances.shape[1]) + nuisances.T @ nuisances)[1]


def _blocks(times):
    """Numbers of the blocks of rows, test by test."""
    blocks, first = [], 0
    for time in times:
        numbers = ((time - time.min()) / _BLOCK).astype(int)
        blocks.append(first + numbers)
        first += numbers.max() + 1
    return np.unique(np.concatenate(blocks), return_inverse=True)[1]


def _of_slab(decision, opened, sealed):
    """`Squares` of the slab's rotation, of an effect that turns it."""
    causes = [part.causes[0] for part in decision.parts if part.readings.startswith("rotation of the slab")]
    if not causes or not sealed:
        return []
    (cause,) = causes
    slabs = [slab_motion(test) for test in [*opened, *sealed]]
    variants = [EFFECTS[cause.name].turns(slab) for slab in slabs]
    rows = [
        next(variant.rows for variant in of_test if variant.values == cause.when) @ cause.amplitudes
        for of_test in variants
    ]
    times = [slab.time[slab.at] for slab in slabs[len(opened) :]]
    return [_squares(slab_turns(slabs), rows, len(opened), times)]


def cause_rows(cause, opened, sealed, likelihood):
    """Rows of a cause by test at its frozen size, (n_rows,) each; None of a cause that predicts nothing of tests to
    come.

    Parameters
    ----------
    cause : Cause
    opened, sealed : list of JointRows
    likelihood : Likelihood
        Of all of these, by which the start of a push in a sealed test is found.
    """
    tests = [*opened, *sealed]
    amplitudes = np.array(cause.amplitudes)
    if not cause.outside:
        effect = EFFECTS[cause.name]
        if effect.columns is None or not len(amplitudes):
            return None
        return [effect.rows_of(test.seen, cause.place, cause.when) @ amplitudes for test in tests]
    form = FORMS[cause.name]
    if form.rows is None or not form.lasts(cause.when):
        return None
    size, when = float(amplitudes[0]), cause.when
    if form.more:
        return [form.rows(test, cause.place, when) @ amplitudes for test in tests]
    if "starts" in when:
        starts = {
            test.seen.name: start_of_push(cause.place, size, test, likelihood, number)
            for number, test in enumerate(sealed, start=len(opened))
        }
        when = {**when, "starts": {**when["starts"], **starts}}
    return [size * form.rows(test, cause.place, when) for test in tests]
