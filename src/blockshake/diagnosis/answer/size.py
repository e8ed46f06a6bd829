"""Parameters of a cause with their intervals, from its posterior over likelihoods, variants and amplitudes."""

import zlib

import numpy as np

from blockshake.diagnosis.answer.decision import MEMBERS, Estimate
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

NINE_TENTHS = 1.645  # standard deviations of a Gaussian, within which they lie
FORM = 0.1  # of a size, by which a cause of another form than the registry's has another one
_DRAWS = 2000
_INTERVAL = (0.05, 0.5, 0.95)


def members_of(name, place, fits, logs):
    """Sets of parameters of a cause at one place, tuple of `MEMBERS` dict; the arguments are those of `size_of`."""
    drawn, order = _drawn(name, place, fits, logs)
    return tuple({key: float(values[draw]) for key, values in drawn.items()} for draw in order[:MEMBERS])


def size_of(name, place, fits, logs):
    """Parameters of a cause, `Estimate` by name.

    Parameters
    ----------
    name : str
        Effect or form.
    place : str
        In words: with the name, the seed.
    fits : list of Fit
    logs : float64 array, shape (n_fits,)
        Logarithms of their weights.
    """
    drawn, _ = _drawn(name, place, fits, logs)
    return {key: _estimate(drawn[key], unit) for key, unit in units_of(name).items()}


def _drawn(name, place, fits, logs):
    """Draws by parameter, and a fixed random order of them."""
    generator = np.random.default_rng([_DRAWS, zlib.crc32(f"{name} {place}".encode())])
    weights = np.exp(logs - logs.max())
    counts = generator.multinomial(_DRAWS, weights / weights.sum())
    parts = [
        read_sizes(name, fit.values, _amplitudes(fit, count, generator), generator.uniform(-0.5, 0.5, count))
        for fit, count in zip(fits, counts, strict=True)
        if count
    ]
    drawn = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    for key in list(units_of(name))[1:]:  # the first one follows the amplitude, which has that error
        drawn[key] = drawn[key] * np.exp(FORM * generator.standard_normal(_DRAWS))
    return drawn, generator.permutation(_DRAWS)


def _amplitudes(fit, count, generator):
    """Draws of a fit's amplitude, several as one of the first column, with the error of the form."""
    mean = float(fit.contrast @ fit.mean)
    variance = float(fit.contrast @ fit.covariance @ fit.contrast) + (FORM * mean) ** 2
    deviation = float(np.sqrt(max(variance, 0.0)))
    drawn = mean + deviation * generator.standard_normal(count)
    return np.abs(drawn) if fit.positive else drawn


def read_sizes(name, values, amplitudes, between):
    """Parameters of a cause by name, arrays, from amplitudes of the variant with these values; see `Effect.reads`."""
    if name in FORMS:
        return {FORMS[name].size: amplitudes}
    read = EFFECTS[name].reads(values, amplitudes, between)
    return {key: np.broadcast_to(value, amplitudes.shape) for key, value in read.items()}


def units_of(name):
    """Units of the parameters of a cause by name, the size first."""
    if name in FORMS:
        return {FORMS[name].size: FORMS[name].unit}
    return {parameter.name: parameter.unit for parameter in EFFECTS[name].parameters}


def _estimate(values, unit):
    lower, middle, upper = (float(value) for value in np.quantile(values, _INTERVAL))
    return Estimate(estimate=middle, lower=lower, upper=upper, unit=unit)
