"""Innovations of a test's short windows by both solvers, and what they say of every candidate."""

import numpy as np
import xarray as xr
from scipy.special import logsumexp

from blockshake.diagnosis.null_model import MODELS, draw_nominal
from blockshake.diagnosis.restart_instants import restart_instants
from blockshake.diagnosis.smoothed_state import smoothed_states
from blockshake.diagnosis.window_scores import Innovations, score_windows
from blockshake.diagnosis.windows import measured_ends, simulate_window, window_model
from blockshake.effects.registry import EFFECTS
from blockshake.measurement.joint_coordinates import find_joints

LONGEST = 0.4  # s
_SHARE = 3.0  # windows in a horizon
_SHORTEST = 0.1  # s: in less nothing shows
_STARTS = 5  # draws of the start
_MODELS = {"ls-dem": 12, "nscd-rigid": 5}  # nominal draws: node layouts differ more than time steps
# What the draws span is taken twice as wide, and what they span at a window once more as its own scatter, for what
# is not linear in them; a start without its contacts' history adds a share of the rotation (tests/diagnosis).
_WIDER, _OWN, _HISTORY = 2.0, 0.3, 0.02
_TRIED = 0.5  # of the visible size, at which tangents are taken
_SIZES = 21
# the middle of what `draw_nominal` draws; time step [s]
_CENTRAL = {"ls-dem": ({}, 5e-5), "nscd-rigid": ({"nscd.impact_parts": 20, "nscd.shrink": 0.01}, 1e-3)}


def window_length(horizon):
    """Length of a window [s]: a third of the predictability horizon, from 0.1 to 0.4 s."""
    return float(np.clip(horizon / _SHARE, _SHORTEST, LONGEST))


def window_evidence(name, structure, source, histories, base, candidates, horizon, progress):
    """Innovations of a measured test and scores of the candidates by them.

    Parameters
    ----------
    name : str
        Of the test.
    structure : Structure
        The campaign's.
    source : str
        Its name or file, for what is varied in it.
    histories : xarray.Dataset
        From `joint_histories`.
    base : BaseMotion
        From `reconstruct_base`.
    candidates : sequence of Candidate
    horizon : float
        Time for which the test can be predicted, from `predictability` [s].
    progress : callable
        Called with a line of text after each model.

    Returns
    -------
    xarray.Dataset
        ``t``, ``size``, ``log_ratio``, ``se(candidate)``: both solvers taken together, each as likely as the other
        before the test (t and size by the one under which the windows are likelier); by solver ``model_t`` and
        ``model_log_ratio(model, candidate)``, ``density(model)``; ``innovation(model, window, coordinate)`` [m, rad],
        ``scatter(model, window, coordinate)``, its standard deviation as expected; ``begin(window)`` [s] and
        ``length`` [s]. Without windows, as where a block's rotation is not known, all scores are NaN.

    Notes
    -----
    Errors of the start and of the readings are those of a window; the nominal draws of each solver, about its middle
    one, are shared by all. The covariance by errors of the start is half that of five draws and half its
    variances' medians over the windows. A tangent is the change by half the visible size: effects far
    from linear, such as a stop, are found and their size is rough.
    """
    length = window_length(horizon)
    time = histories["time"].to_numpy()
    n_steps = round(length / float(np.median(np.diff(time))))
    states = smoothed_states(histories, structure)
    places = restart_instants(histories, length) if states else np.empty(0, dtype=np.int64)
    keys = [candidate.key for candidate in candidates]
    names = _coordinate_names(structure)
    if not len(places):
        return _without_windows(keys, names, length)
    measured, noise = measured_ends(histories, places, n_steps)

    def ends(model, start=None):
        return np.array(
            [
                simulate_window(
                    model, structure, states, place, n_steps,
                    None if start is None else np.random.default_rng([start, int(place), *name.encode()]),
                )
                for place in places
            ]
        )  # fmt: skip

    central = {solver: window_model(solver, source, base, *_CENTRAL[solver]) for solver in MODELS}
    middle = {solver: ends(central[solver]) for solver in MODELS}
    cheap = MODELS[1]
    off = np.array([ends(central[cheap], start) for start in range(_STARTS)]) - middle[cheap]
    progress(f"{name}: {len(places)} windows of {length:.2f} s from {_STARTS} starts")
    covariance = _start_covariance(off) + noise[:, :, None] ** 2 * np.eye(len(names))
    scores, innovations = {}, {}
    for solver in MODELS:
        drawn = []
        for number in range(_MODELS[solver]):
            draw = draw_nominal(source, solver, number)
            drawn.append(ends(window_model(solver, source, base, draw.parameters, draw.time_step)))
        shared = _WIDER * np.moveaxis(np.array(drawn) - middle[solver], 0, 2) / np.sqrt(_MODELS[solver])
        own = _OWN**2 * np.nan_to_num(shared**2).sum(axis=2) + np.nan_to_num(_HISTORY * middle[solver]) ** 2
        innovations[solver] = Innovations(
            measured - middle[solver], covariance + own[:, :, None] * np.eye(len(names)), shared
        )
        progress(f"{name}: {solver}, {_MODELS[solver]} nominal draws")
        for candidate in candidates:
            values, sizes = _tried(candidate)
            model = window_model(
                solver, source, base, *_CENTRAL[solver], effects=[candidate.as_effect(values)]
            )
            tangent = (ends(model) - middle[solver]) / _TRIED
            scores[solver, candidate.key] = score_windows(
                innovations[solver], tangent, sizes, [*name.encode(), *candidate.key.encode()]
            )
            progress(f"{name}: {solver}, {candidate.key}")
    return _gathered(scores, innovations, keys, names, time[places], length)


def _coordinate_names(structure):
    """Names of what `simulate_window` gives."""
    names = structure.body_names
    joints = [f"{names[lower]}-{names[upper]}" for lower, upper in find_joints(structure)[0]]
    return [f"{kind}.{joint}" for kind in ("slip", "rotation") for joint in joints] + [
        "base.pitch",
        "base.vertical",
    ]


def _tried(candidate):
    """Parameter values at which a candidate's tangent is taken, and the sizes of its prior in units of the visible."""
    size, *others = EFFECTS[candidate.effect].parameters
    unit = size.visible - size.null
    ends = (size.lower - size.null) / unit, (size.upper - size.null) / unit
    values = {size.name: size.null + _TRIED * unit} | {item.name: item.visible for item in others}
    return values, np.linspace(min(ends), max(ends), _SIZES)


def _start_covariance(off):
    """Covariance by errors of the start, (n_windows, n_coordinates, n_coordinates), from (n_draws, n_windows, ...)."""
    own = np.einsum("dwi,dwj->wij", np.nan_to_num(off), np.nan_to_num(off)) / len(off)
    usual = np.median(np.diagonal(own, axis1=1, axis2=2), axis=0)
    return 0.5 * own + 0.5 * np.diag(usual)


def _gathered(scores, innovations, keys, names, begin, length):
    density = np.array([scores[solver, keys[0]].null_density for solver in MODELS])
    likelier = MODELS[int(np.argmax(density))]
    by_model = {
        what: np.array([[getattr(scores[solver, key], what) for key in keys] for solver in MODELS])
        for what in ("t", "density", "null_density")
    }
    both = logsumexp(by_model["density"], axis=0) - logsumexp(by_model["null_density"], axis=0)
    scatter = [
        np.sqrt(np.diagonal(part.covariance, axis1=1, axis2=2) + np.nan_to_num(part.shared**2).sum(axis=2))
        for part in innovations.values()
    ]
    return xr.Dataset(
        {
            "t": ("candidate", [scores[likelier, key].t for key in keys]),
            "size": ("candidate", [scores[likelier, key].size for key in keys]),
            "log_ratio": ("candidate", both),
            "se": ("candidate", [scores[likelier, key].error for key in keys]),
            "model_t": (("model", "candidate"), by_model["t"]),
            "model_log_ratio": (("model", "candidate"), by_model["density"] - by_model["null_density"]),
            "density": ("model", density),
            "innovation": (
                ("model", "window", "coordinate"), np.array([part.values for part in innovations.values()])
            ),
            "scatter": (("model", "window", "coordinate"), np.array(scatter)),
            "length": ((), length, {"units": "s"}),
        },
        {"candidate": keys, "model": list(MODELS), "coordinate": names, "begin": ("window", begin, {"units": "s"})},
        {"n_windows": len(begin)},
    )  # fmt: skip


def _without_windows(keys, names, length):
    unknown = np.full(len(keys), np.nan)
    by_model = np.tile(unknown, (len(MODELS), 1))
    nothing = np.empty((len(MODELS), 0, len(names)))
    return xr.Dataset(
        {
            **{key: ("candidate", unknown) for key in ("t", "size", "log_ratio", "se")},
            "model_t": (("model", "candidate"), by_model),
            "model_log_ratio": (("model", "candidate"), by_model),
            "density": ("model", np.full(len(MODELS), np.nan)),
            "innovation": (("model", "window", "coordinate"), nothing),
            "scatter": (("model", "window", "coordinate"), nothing),
            "length": ((), length, {"units": "s"}),
        },
        {
            "candidate": keys, "model": list(MODELS), "coordinate": names,
            "begin": ("window", np.empty(0), {"units": "s"}),
        },
        {"n_windows": 0},
    )  # fmt: skip
