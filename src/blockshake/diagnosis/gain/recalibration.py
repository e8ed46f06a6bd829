"""Recalibration: uncertain parameters of nominal models, conditioned on the open tests."""

from dataclasses import replace

import numpy as np
from scipy.special import ndtr, ndtri

from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.simulation.models import model_of

# drawn evenly in `draw_nominal`; hollows are so in their logarithm, and all others log-normally
_EVEN = {one.name for name in MODELS for one in model_of(name).perturbation.uncertain}
_REGULARISATION = np.logspace(-2.0, 3.0, 11)  # over the mean square that a draw's features have
_SHUFFLES = 199
_INFORMED_CHANCE = 0.01  # below which a parameter is held to be informed
_INTERVAL = 0.1  # s, between instants that parameters are conditioned on
_REACH = 3.0  # standard deviations of the draws within which a parameter stays and a feature counts


def features_of(tests):
    """The histories of the open tests, on which parameters are conditioned.

    Parameters
    ----------
    tests : list of JudgedTest
        Of ensembles of one kind by one solver, the same members in all.

    Returns
    -------
    features : float64 array, shape (n_draws, n_features)
        Every cell some ten times a second until its horizon, in units of its spread over the members (root mean
        square over the time); instants that a member or the measured test lacks are left out.
    measured : float64 array, shape (n_features,)
    """
    features, measured = [], []
    for test in tests:
        ((_, members),) = test.members.items()
        time = test.measured["time"].to_numpy()
        stride = max(round(_INTERVAL / np.median(np.diff(time))), 1)
        values, read = members.to_numpy()[:, ::stride], test.measured.to_numpy()[::stride]
        known = test.judged[::stride] & np.isfinite(read) & np.isfinite(values).all(axis=0)
        variance = np.where(known, np.where(known, values, 0.0).var(axis=0, ddof=1), 0.0)
        spread = np.sqrt(variance.sum(axis=0) / np.maximum(known.sum(axis=0), 1))
        known &= spread > 0.0
        scale = np.where(spread > 0.0, spread, 1.0)
        features.append((values / scale)[:, known])
        measured.append((read / scale)[known])
    return np.concatenate(features, axis=1), np.concatenate(measured)


def posterior_draws(draws, features, measured):
    """Draws of one solver, conditioned on the open tests.

    Parameters
    ----------
    draws : list of Draw, length n_draws
        One solver.
    features : float64 array, shape (n_draws, n_features)
        That they gave, noise of the sensors in them, from `features_of`.
    measured : float64 array, shape (n_features,)

    Returns
    -------
    list of Draw
        A parameter that the tests do not inform keeps its values.

    Notes
    -----
    Conditional simulation of a joint Gaussian, ``theta_i + K (measured - y_i)`` with
    ``K = C_ty (C_yy + lambda I)^-1``: Matheron's rule, which is one step of an ensemble Kalman filter with perturbed
    observations (Evensen 2003, Ocean Dynamics 53; Iglesias, Law and Stuart 2013, Inverse Problems 29), as draws with
    noise in their features are. ``theta`` is the logarithm of a parameter, or the normal score of one that is drawn
    evenly, itself or in its logarithm, between ends that follow from the draws.

    Features outnumber draws, so chance correlations would move parameters that the tests do not know. Three guards:
    ``lambda`` is the one that predicts left-out draws best, by parameter; a parameter without more skill than it has
    in the 99th of 100 shufflings of the draws has ``K = 0``; and draw i is moved by the gain learnt from the others
    (Houtekamer and Mitchell 1998, Mon. Weather Rev. 126), since a draw that taught the gain would be
    fitted too well and the posterior come out too narrow.

    The gain was learnt within the draws. A measured feature that lies more than three standard deviations off them
    counts as one at three, and parameters stop at three prior standard deviations.

    Places, time step and seed stay each draw's own, and so does a parameter in which all draws agree.
    """
    names = [*draws[0].parameters, "amplitude"]
    names = [name for name in names if len({_value(draw, name) for draw in draws}) > 1]
    values = np.array([[_value(draw, name) for name in names] for draw in draws])
    ends = [_ends(name, column) for name, column in zip(names, values.T, strict=True)]
    scores = np.column_stack(
        [_score(name, column, end) for name, column, end in zip(names, values.T, ends, strict=True)]
    )
    strength, chance = _regularisation(scores, features)
    informed = chance <= _INFORMED_CHANCE

    reach = features.mean(axis=0) + _REACH * features.std(axis=0, ddof=1) * [[-1.0], [1.0]]
    innovations = np.clip(measured, *reach) - features
    moved = scores.copy()
    moved[:, informed] += _shifts(scores[:, informed], features, innovations, strength[informed])
    mean, deviation = scores.mean(axis=0), scores.std(axis=0, ddof=1)
    moved = np.clip(moved, mean - _REACH * deviation, mean + _REACH * deviation)
    posterior = np.column_stack(
        [_unscore(name, column, end) for name, column, end in zip(names, moved.T, ends, strict=True)]
    )
    posterior = np.where(informed, posterior, values)
    return [
        _with_values(draw, dict(zip(names, row.tolist(), strict=True)))
        for draw, row in zip(draws, posterior, strict=True)
    ]


def _value(draw, name):
    return draw.amplitude if name == "amplitude" else draw.parameters[name]


def _with_values(draw, values):
    parameters = {name: values.get(name, value) for name, value in draw.parameters.items()}
    return replace(draw, parameters=parameters, amplitude=values.get("amplitude", draw.amplitude))


def _ends(name, values):
    """Ends of what is drawn evenly, as its draws tell them without bias; None for the others."""
    if name not in _EVEN and not name.endswith(".hollow"):
        return None
    values = _evened(name, values)
    beyond = (values.max() - values.min()) / (len(values) - 1)
    lower = values.min() - beyond
    return max(0.0, lower) if name in _EVEN else lower, values.max() + beyond


def _evened(name, values):
    """A parameter on the scale on which its prior is even or Gaussian."""
    return values if name in _EVEN else np.log(values)


def _score(name, values, ends):
    """A parameter on the scale on which its prior is Gaussian."""
    values = _evened(name, values)
    if ends is None:
        return values
    lower, upper = ends
    # the lowest draw may stand on an end that was cut off at 0
    share = np.clip((values - lower) / (upper - lower), 0.1 / len(values), 1.0 - 0.1 / len(values))
    return ndtri(share)


def _unscore(name, scores, ends):
    values = scores if ends is None else ends[0] + (ends[1] - ends[0]) * ndtr(scores)
    return values if name in _EVEN else np.exp(values)


def _regularisation(scores, features):
    """By parameter: the regularisation with most skill on left-out draws, and the chance of that skill by shuffling."""
    count = len(scores)
    centred = features - features.mean(axis=0)
    gram = centred @ centred.T
    strengths = _REGULARISATION * np.trace(gram) / count
    # the same shuffles for all parameters: those that go together stay together
    generator = np.random.default_rng([count, _SHUFFLES])
    orders = np.array([np.arange(count), *(generator.permutation(count) for _ in range(_SHUFFLES))])
    shuffled = scores[orders].transpose(1, 0, 2).reshape(count, -1)
    from_mean = (shuffled - shuffled.mean(axis=0)) * count / (count - 1)
    skills = []
    for strength in strengths:
        hat = np.full((count, count), 1.0 / count) + gram @ np.linalg.inv(gram + strength * np.eye(count))
        left_out = (shuffled - hat @ shuffled) / (1.0 - np.diag(hat))[:, None]
        skills.append(1.0 - (left_out**2).sum(axis=0) / (from_mean**2).sum(axis=0))
    skills = np.array(skills).reshape(len(strengths), len(orders), -1)
    best = skills.max(axis=0)
    chance = (best >= best[0] - 1e-12).mean(axis=0)  # the draws as they are among them
    return strengths[skills[:, 0].argmax(axis=0)], chance


def _shifts(scores, features, innovations, strengths):
    """Shift of each draw's scores, shape (n_draws, n_parameters), by the gain learnt from the other draws."""
    shifts = np.empty((len(innovations), scores.shape[1]))
    for draw, innovation in enumerate(innovations):
        others = np.arange(len(scores)) != draw
        known = features[others] - features[others].mean(axis=0)
        power, axes = np.linalg.eigh(known @ known.T)
        seen = axes.T @ (known @ innovation)
        known_of = axes.T @ (scores[others] - scores[others].mean(axis=0))
        shifts[draw] = (known_of * (seen[:, None] / (power[:, None] + strengths))).sum(axis=0)
    return shifts
