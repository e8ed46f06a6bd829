"""Gain on sealed tests of a filmed body: whole paths by the nominal, the recalibrated and the extended model."""

from dataclasses import replace
from itertools import product

import numpy as np
import xarray as xr

from blockshake.diagnosis.flight.causes import CAUSES
from blockshake.diagnosis.flight.evidence import FlightFit, flight_rows
from blockshake.diagnosis.flight.replay import FlightModel, replay, start_arc
from blockshake.diagnosis.gain.campaign_gain import CampaignGain
from blockshake.diagnosis.nominal.ensemble import DISCREPANCY, EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.forces.flight.arcs import find_arcs
from blockshake.statistics.resampling import resampled_weights

_FRICTION = (0.03, 0.06, 0.1, 0.15, 0.22, 0.33, 0.5)
_RESTITUTION = (0.0, 0.15, 0.3, 0.45, 0.6)
_FINER = (0.75, 0.85, 1.0, 1.1, 1.25)  # times the best friction of these
_BESIDE = (-0.1, -0.05, 0.0, 0.05, 0.1)  # beside the best restitution of these
_MOST = 60  # open tests that a model is fitted to
_EARLY = 0.1  # s after the first flight
_ACTING = ("sensor-gain", "eccentricity", "push", "drag")  # causes that a replay can have
KINDS = (NOMINAL, RECALIBRATED, DISCREPANCY, EXTENDED)


def flight_gain(opened, sealed, decision):
    """Gain of a decision's causes on sealed tests.

    Parameters
    ----------
    opened, sealed : PosedCampaign
    decision : Decision

    Returns
    -------
    CampaignGain
        ``scores``: ``place`` and ``early(test, kind)``, mean distance of the body's middle over the whole path and
        until 0.1 s after the first flight [m]; ``turn(test, kind)``, mean angle between the rotations [rad];
        ``friction`` and ``restitution(kind)``. The gain is on ``place``.

    Notes
    -----
    Every model starts a test from what its first flight shows. Recalibrated and extended model have the friction and
    the restitution that make the paths of the open tests shortest apart, without and with the causes. Where free flight
    does not tell forms apart, the open paths choose. The discrepancy without a name is the mean acceleration that open
    flights have beyond gravity.
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
    models, best, count = {NOMINAL: _nominal(opened)}, np.inf, 0
    models[RECALIBRATED], _, runs = _recalibrated(opened, fitted, models[NOMINAL])
    count += runs
    models[DISCREPANCY] = replace(models[RECALIBRATED], shift=tuple(shift.tolist()))
    for fits in choices:
        model, error, runs = _recalibrated(opened, fitted, replace(models[NOMINAL], fits=fits))
        count += runs
        if error < best:
            models[EXTENDED], best = model, error
    scores = _scores(sealed, able, models)
    scores = scores.assign(
        friction=("kind", [models[kind].friction for kind in KINDS]),
        restitution=("kind", [models[kind].restitution for kind in KINDS]),
    )
    chosen = [fit.cause.title for fit in models[EXTENDED].fits]
    caveats = [f"the model was extended by {' and '.join(chosen)}, by the paths of the open tests"]
    if len(able) < len(sealed.tests):
        left = len(sealed.tests) - len(able)
        caveats.append(f"{left} sealed tests have no free flight, and were not predicted")
    count += len(able) * len(models)
    return CampaignGain(
        MeasuredGain(rows=rows, gain=_contrasts(scores["place"]), caveats=tuple(caveats), runs=count), scores
    )


def _nominal(posed):
    bodies, friction = posed.structure.file, posed.structure.friction
    (ground,) = np.flatnonzero(posed.structure.driven)
    return FlightModel(float(friction[posed.body, ground]), float(bodies.nscd_restitution))


def _combinations(decision):
    """Causes by which a model may be extended: of every part one that is not told from the likeliest."""
    parts = [[cause for cause in part.causes if cause.name in _ACTING] for part in decision.parts]
    by_name = {cause.name: cause for cause in CAUSES}
    for chosen in product(*(part for part in parts if part)):
        yield tuple(
            FlightFit(by_name[one.name], one.gain, np.array(one.amplitudes), np.zeros((0, 0)))
            for one in chosen
        )


def _fitted_tests(posed, arcs, most=_MOST):
    """At most some tests that can be replayed, spread evenly, with their first flights."""
    able = [(test, arc) for test in posed.tests if (arc := start_arc(test, arcs)) is not None]
    return able[:: max(1, -(-len(able) // max(most, 1)))]


def _recalibrated(posed, tests, model):
    """The model with friction and restitution by a grid, refined once; its mean error, and the number of runs."""
    errors = {}

    def error(friction, restitution):
        key = friction, restitution
        if key not in errors:
            tried = replace(model, friction=friction, restitution=restitution)
            errors[key] = np.mean([np.nanmean(replay(posed, test, arc, tried).middle) for test, arc in tests])
        return errors[key]

    coarse = min(product(_FRICTION, _RESTITUTION), key=lambda one: error(*one))
    finer = [
        (coarse[0] * factor, float(np.clip(coarse[1] + step, 0.0, 1.0)))
        for factor, step in product(_FINER, _BESIDE)
    ]
    best = min(finer, key=lambda one: error(*one))
    return (
        replace(model, friction=best[0], restitution=best[1]), error(*best), len(errors) * len(tests)
    )  # fmt: skip


def _scores(posed, tests, models):
    rows = []
    for test, arc in tests:
        runs = [replay(posed, test, arc, models[kind]) for kind in KINDS]
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


def _row_gain(posed, arcs, decision, shift):
    """Gain on the sealed flights' own rows, at the frozen sizes; flights drawn again."""
    rows, by_name = flight_rows(posed, arcs), {cause.name: cause for cause in CAUSES}
    fits = [(by_name[part.causes[0].name], np.array(part.causes[0].amplitudes)) for part in decision.parts]
    paths = {
        RECALIBRATED: lambda arc: np.zeros((len(arc.time), 3)),
        EXTENDED: lambda arc: sum(
            np.einsum("nkx,k->nx", cause.paths(arc, posed), sizes) for cause, sizes in fits
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
