"""Parameters of a cause with their intervals, from its posterior over likelihoods, variants and amplitudes."""

import zlib

import numpy as np
import scipy

from blockshake.diagnosis.answer.decision import MEMBERS, Estimate
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

NINE_TENTHS = 1.645  # standard deviations of a Gaussian, within which they lie
FORM = 0.1  # of a size, by which a cause of another form than the registry's has another one
_DRAWS = 2000
_INTERVAL = (0.05, 0.95)


def members_of(name, place, fits, logs):
    """Sets of parameters of a cause at one place, tuple of `MEMBERS` dict, by its fits and their logarithms."""
    drawn, order = _drawn(name, place, fits, logs)
    return tuple({key: float(values[draw]) for key, values in drawn.items()} for draw in order[:MEMBERS])


def size_of(name, place, here, alike):
    """Parameters of a cause, `Estimate` by name: at one place, in intervals that hold for all that are not
    distinguished.

    Parameters
    ----------
    name : str
        Effect or form.
    place : str
        In words: with the name, the seed.
    here, alike : pair of list of Fit and float64 array, shape (n_fits,)
        Fits at the place, and at all such places, with the logarithms of their weights.
    """
    own, drawn = (_drawn(name, place, *fitted)[0] for fitted in (here, alike))
    return {key: _estimate(own[key], drawn[key], unit) for key, unit in units_of(name).items()}


def _drawn(name, place, fits, logs):
    """Draws by parameter, and a fixed random order of them."""
    generator = np.random.default_rng([_DRAWS, zlib.crc32(f"{name} {place}".encode())])
    weights = np.exp(logs - logs.max())
    counts = generator.multinomial(_DRAWS, weights / weights.sum())
    parts = [
        read_sizes(name, fit.values, _amplitudes(fit, count, generator), generator.uniform(-0.5, 0.5, count))
        | _further(name, fit, count, generator)
        for fit, count in zip(fits, counts, strict=True)
        if count
    ]
    drawn = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    for key in list(units_of(name))[1:]:  # the first one follows the amplitude, which has that error
        drawn[key] = drawn[key] * np.exp(FORM * generator.standard_normal(_DRAWS))
    return drawn, generator.permutation(_DRAWS)


def _amplitudes(fit, count, generator):
    """Draws of a fit's size, with the error of the form, within its support."""
    mean, deviation = fit.size
    deviation = max(float(np.hypot(deviation, FORM * mean)), np.finfo(float).tiny)
    lower, upper = (-mean if fit.positive else -fit.most - mean) / deviation, (fit.most - mean) / deviation
    drawn = scipy.stats.truncnorm.rvs(lower, upper, size=count, random_state=generator)
    return mean + deviation * drawn


def _further(name, fit, count, generator):
    """Draws of the further sizes of a form by name, none of them negative."""
    more = FORMS[name].more if name in FORMS else ()
    means, deviations = fit.mean[1:], np.sqrt(np.diag(fit.covariance)[1:])
    return {
        key: scipy.stats.truncnorm.rvs(
            -mean / deviation, np.inf, mean, deviation, count, random_state=generator
        )
        for (key, _), mean, deviation in zip(more, means, deviations, strict=False)
    }


def read_sizes(name, values, amplitudes, between):
    """Parameters of a cause by name, arrays, from amplitudes of the variant with these values; see `Effect.reads`."""
    if name in FORMS:
        return {FORMS[name].size: amplitudes}
    read = EFFECTS[name].reads(values, amplitudes, between)
    return {key: np.broadcast_to(value, amplitudes.shape) for key, value in read.items()}


def units_of(name):
    """Units of the parameters of a cause by name, the size first."""
    if name in FORMS:
        return FORMS[name].units
    return {parameter.name: parameter.unit for parameter in EFFECTS[name].parameters}


def _estimate(own, drawn, unit):
    middle = float(np.median(own))
    lower, upper = (float(value) for value in np.quantile(drawn, _INTERVAL))
    return Estimate(estimate=middle, lower=min(lower, middle), upper=max(upper, middle), unit=unit)
