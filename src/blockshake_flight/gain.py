"""Gain on sealed tests of a filmed body: whole paths by the nominal, the recalibrated and the extended model."""

from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.campaign_gain import CampaignGain
from blockshake.diagnosis.nominal.ensemble import DISCREPANCY, EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.statistics.resampling import resampled_weights
from blockshake_flight.arcs import find_arcs
from blockshake_flight.causes import CAUSES
from blockshake_flight.evidence import FlightFit, flight_rows
from blockshake_flight.inertia import OF_RATIOS, seen_ratios
from blockshake_flight.replay import FlightModel, replay, start_arc
from blockshake_flight.tracked_test import load_tracked

_FRICTION = (0.03, 0.06, 0.1, 0.15, 0.22, 0.33, 0.5)
_RESTITUTION = (0.0, 0.15, 0.3, 0.45, 0.6)
_FINER = (0.75, 0.85, 1.0, 1.1, 1.25)  # times the best friction of these
_STEPS = (-0.1, -0.05, 0.0, 0.05, 0.1)  # next to the best restitution of these
_INERTIA = (0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4)  # times the moments of inertia
_MOST = 60  # open tests that a model is fitted to
_HALVES = 100  # random halves of these, on which a model is chosen
_EARLY = 0.1  # s after the first flight
_ACTING = ("sensor-gain", "eccentricity", "push", "drag")  # causes that a replay can have
_LEAST_HALVED = 4  # open tests
KINDS = (NOMINAL, RECALIBRATED, DISCREPANCY, EXTENDED)


class _Recalibrated(NamedTuple):
    """A model fitted to open paths, the interval of 90 % of the factor on its inertia, tests drawn again, and the mean
    errors of all that was tried, (n_tried, n_tests) [m]."""

    model: FlightModel
    between: np.ndarray
    errors: np.ndarray


def measure_gain(campaign, decision, effort, files):
    """`CampaignGain` of a campaign, see `CampaignKind`; at every effort the same, and by no file."""
    opened, sealed = (load_tracked(campaign, list(tests)) for tests in (campaign.open, campaign.sealed))
    return flight_gain(opened, sealed, decision)


def flight_gain(opened, sealed, decision):
    """Gain of a decision's causes on sealed tests.

    Parameters
    ----------
    opened, sealed : TrackedCampaign
    decision : Decision

    Returns
    -------
    CampaignGain
        ``scores``: ``place`` and ``early(test, kind)``, mean distance of the body's middle over the whole path and
        until 0.1 s after the first flight [m]; ``turn(test, kind)``, mean angle between the rotations [rad];
        ``friction`` and ``restitution(kind)``, ``inertia(kind, axis)``, the moments over the structure file's. The gain
        is on ``place``.

    Notes
    -----
    Every model starts a test from what its first flight shows. Recalibrated and extended model have the friction and
    the restitution that make the paths of the open tests shortest apart, without and with the causes, and the size of
    the moments of inertia where flights tell their ratios (`seen_ratios`). Where free flight does not tell forms apart,
    the open paths choose. The discrepancy without a name is the mean acceleration that open flights have beyond
    gravity.
    """
    arcs_opened, arcs_sealed = find_arcs(opened)[0], find_arcs(sealed)[0]
    shift = np.mean([arc.acceleration for arc in arcs_opened], axis=0) - opened.structure.file.gravity
    shift[[axis for axis in range(3) if axis not in arcs_opened[0].axes]] = 0.0
    rows = _row_gain(sealed, arcs_sealed, decision, shift) if arcs_sealed else None
    fitted = _fitted_tests(opened, arcs_opened)
    able = _fitted_tests(sealed, arcs_sealed, most=len(sealed.tests))
    choices = [fits for fits in _combinations(decision) if fits]
    if not (fitted and able and choices):
        why = "no open or no sealed test has a free flight" if choices else "no replay can have the causes"
        caveats = (f"no gain was measured on the paths: {why}",)
        return CampaignGain(MeasuredGain(rows=rows, caveats=caveats), xr.Dataset())
    models, best, free = {NOMINAL: _nominal(opened)}, np.inf, _nominal(opened)
    sizes = (1.0,)
    if ratios := seen_ratios(opened, arcs_opened):
        free, sizes = replace(free, inertia=tuple((ratios[0] @ OF_RATIOS).tolist())), _INERTIA
    plain = _recalibrated(opened, fitted, free, sizes)
    models[RECALIBRATED], count = plain.model, len(plain.errors) * len(fitted)
    models[DISCREPANCY] = replace(models[RECALIBRATED], shift=tuple(shift.tolist()))
    for fits in choices:
        tried = _recalibrated(opened, fitted, replace(free, fits=fits), sizes)
        count += len(tried.errors) * len(fitted)
        if tried.errors.mean(axis=1).min() < best:
            extended, best = tried, tried.errors.mean(axis=1).min()
    models[EXTENDED] = extended.model
    scores = _scores(sealed, able, models)
    scores = scores.assign(
        friction=("kind", [models[kind].friction for kind in KINDS]),
        restitution=("kind", [models[kind].restitution for kind in KINDS]),
        inertia=(("kind", "axis"), [np.exp(models[kind].inertia) for kind in KINDS]),
        of_halves=("half", gains_of_halves(plain.errors, extended.errors)),
        axis=list("xyz"),
    )
    chosen = [fit.cause.title for fit in models[EXTENDED].fits]
    caveats = [f"the model was extended by {' and '.join(chosen)}, by the paths of the open tests"]
    caveats += [halves_words(scores["of_halves"].to_numpy())] if scores.sizes["half"] else []
    if ratios:
        size = float(np.exp(np.mean(models[EXTENDED].inertia)))
        most = ", the most that was tried" if round(size, 6) == max(sizes) else ""
        lower, upper = extended.between
        words = f"{size:.2g} ({lower:.2g} to {upper:.2g}) times the stated moments of inertia"
        caveats.append(f"these paths are shortest apart with {words}{most}")
    if len(able) < len(sealed.tests):
        left = len(sealed.tests) - len(able)
        caveats.append(f"{left} sealed tests have no free flight, and were not predicted")
    count += len(able) * len(models)
    return CampaignGain(
        MeasuredGain(rows=rows, gain=_contrasts(scores["place"]), caveats=tuple(caveats), runs=count), scores
    )


def _nominal(tracked):
    bodies, friction = tracked.structure.file, tracked.structure.friction
    (ground,) = np.flatnonzero(tracked.structure.driven)
    return FlightModel(float(friction[tracked.body, ground]), float(bodies.nscd_restitution))


def _combinations(decision):
    """Causes by which a model may be extended: one of each part, as plausible as the best."""
    parts = [[cause for cause in part.causes if cause.name in _ACTING] for part in decision.parts]
    by_name = {cause.name: cause for cause in CAUSES}
    for chosen in product(*(part for part in parts if part)):
        yield tuple(
            FlightFit(by_name[one.name], one.gain, np.array(one.amplitudes), np.zeros((0, 0)))
            for one in chosen
        )


def _fitted_tests(tracked, arcs, most=_MOST):
    """At most some tests that can be replayed, spread evenly, with their first flights."""
    able = [(test, arc) for test in tracked.tests if (arc := start_arc(test, arcs)) is not None]
    return able[:: max(1, -(-len(able) // max(most, 1)))]


def _recalibrated(tracked, tests, model, sizes):
    """`_Recalibrated` with friction, restitution and inertia by a grid, refined once; the factor on its moments of
    inertia is one of the sizes."""
    errors = {}

    def of_tests(*key):
        if key not in errors:
            friction, restitution, size = key
            inertia = tuple((np.array(model.inertia) + np.log(size)).tolist())
            tried = replace(model, friction=friction, restitution=restitution, inertia=inertia)
            errors[key] = [np.nanmean(replay(tracked, test, arc, tried).middle) for test, arc in tests], tried
        return errors[key][0]

    def mean(key):
        return np.mean(of_tests(*key))

    friction, restitution, _ = min(product(_FRICTION, _RESTITUTION, [1.0]), key=mean)
    by_size = np.array([of_tests(friction, restitution, size) for size in sizes])
    size = sizes[int(by_size.mean(axis=1).argmin())]
    weights = resampled_weights(len(tests), np.random.default_rng([len(tests), 45]))
    between = np.quantile(np.array(sizes)[(weights @ by_size.T).argmin(axis=1)], (0.05, 0.95))
    finer = [
        (friction * factor, float(np.clip(restitution + step, 0.0, 1.0)), size)
        for factor, step in product(_FINER, _STEPS)
    ]
    best = min(finer, key=mean)
    return _Recalibrated(errors[best][1], between, np.array([own for own, _ in errors.values()]))


def gains_of_halves(without, with_causes):
    """Gains over the recalibrated model on random halves of the open tests, each model chosen on the other half.

    Parameters
    ----------
    without, with_causes : float64 arrays, shape (n_tried, n_tests)
        Mean errors of all that was tried, without and with the causes [m].

    Returns
    -------
    float64 array, shape (n_halves,)
        Empty of fewer than four tests. The sizes of the causes are those of all open tests.
    """
    count = without.shape[1]
    random, gains = np.random.default_rng([count, 44]), []
    for _ in range(_HALVES if count >= _LEAST_HALVED else 0):
        order = random.permutation(count)
        chosen, judged = order[: count // 2], order[count // 2 :]
        rival, extended = (
            errors[errors[:, chosen].mean(axis=1).argmin(), judged].mean()
            for errors in (without, with_causes)
        )
        gains.append(1.0 - extended / rival)
    return np.array(gains)


def halves_words(gains):
    """Sentence on the halves over which a gain holds, from `gains_of_halves`."""
    lower, middle, upper = 100.0 * np.quantile(gains, (0.05, 0.5, 0.95))
    return (
        f"on {(gains > 0.0).sum()} of {len(gains)} random halves of the open tests, the models chosen on the other "
        f"half, the causes gain over the recalibrated model: {middle:.1f} % in the median, {lower:.1f} to {upper:.1f} "
        "% in nine of ten halves"
    )


def _scores(tracked, tests, models):
    rows = []
    for test, arc in tests:
        runs = [replay(tracked, test, arc, models[kind]) for kind in KINDS]
        until = np.searchsorted(test.time[arc.first :], test.time[arc.last] + _EARLY)
        rows.append([
            [np.nanmean(run.middle), np.nanmean(run.middle[:until]), np.nanmean(run.turned)] for run in runs
        ])  # fmt: skip
    table = np.array(rows).reshape(-1, len(KINDS), 3)
    return xr.Dataset(
        {
            name: (("test", "kind"), table[..., number], {"units": unit})
            for number, (name, unit) in enumerate((("place", "m"), ("early", "m"), ("turn", "rad")))
        },
        {"test": [test.name for test, _ in tests], "kind": list(KINDS)},
    )


def _contrasts(error):
    """`Gain` of mean errors over tests, tests drawn again."""
    count = error.sizes["test"]
    weights = resampled_weights(count, np.random.default_rng([count, 42])) / count
    means = {str(kind): weights @ error.sel(kind=kind).to_numpy() for kind in error["kind"].values}
    return Gain(
        **{
            rival: Contrast.of_errors(means[rival], means[EXTENDED])
            for rival in (RECALIBRATED, NOMINAL, DISCREPANCY)
        }
    )


def _row_gain(tracked, arcs, decision, shift):
    """Gain on the sealed flights' own rows, at the frozen sizes; flights drawn again."""
    rows, by_name = flight_rows(tracked, arcs), {cause.name: cause for cause in CAUSES}
    fits = [(by_name[part.causes[0].name], np.array(part.causes[0].amplitudes)) for part in decision.parts]
    paths = {
        RECALIBRATED: lambda arc: np.zeros((len(arc.time), 3)),
        EXTENDED: lambda arc: sum(
            np.einsum("nkx,k->nx", cause.paths(arc, tracked), sizes) for cause, sizes in fits
        ),
        DISCREPANCY: lambda arc: 0.5 * arc.time[:, None] ** 2 * shift,
    }
    squares = {}
    for kind, path in paths.items():
        columns = rows.columns(lambda arc, path=path: path(arc)[:, None])
        value = rows.likelihood.value - rows.likelihood.whiten(columns)[:, 0]
        squares[kind] = np.add.reduceat(value**2, rows.likelihood.ends[:-1])
    count = len(rows.likelihood.roots)
    weights = resampled_weights(count, np.random.default_rng([count, 43]))
    means = {kind: weights @ own for kind, own in squares.items()}
    contrasts = {
        rival: Contrast.of_errors(means[rival], means[EXTENDED]) for rival in (RECALIBRATED, DISCREPANCY)
    }
    return Gain(**contrasts, nominal=contrasts[RECALIBRATED])
