"""Members of the model extended by a candidate: their sizes and nominal parameters fit the open tests."""

import numpy as np

from blockshake.diagnosis.gain.recalibration import posterior_draws
from blockshake.diagnosis.inference.model_evidence import size_grid
from blockshake.diagnosis.inference.response import fit_response

_DENSITY_POINTS = 2001  # points at which the density of sizes is summed


def open_features(library, model):
    """Features of a library's nominal draws by one model, of all its open tests side by side: (n_draws, n_features)."""
    return np.concatenate([test[model]["nominal"] for test in library.tamed], axis=1)


def open_responses(library, model, key):
    """List of `Response` of the features to a candidate, by its key, for each test of a library, by one model."""
    sizes = library.sizes[model][key]
    return [
        fit_response(sizes, test[model][key] - test[model]["nominal"][: len(sizes)], size_grid(sizes))
        for test in library.tamed
    ]


def extended_members(candidate, posterior, draws, features, measured, responses, count):
    """Members of the extended model: sizes from their posterior, nominal parameters that fit beside them.

    Parameters
    ----------
    candidate : Candidate
    posterior : (float64 array, float64 array), shape (n_sizes,)
        Sizes, in units of the visible one, and their weights.
    draws : list of Draw
        Of one solver, those of the library by their numbers.
    features : float64 array, shape (n_draws, n_features)
        From `open_features`.
    measured : float64 array, shape (n_features,)
        Of the open tests side by side, tamed.
    responses : list of Response
        From `open_responses`.
    count : int
        Members wanted, at most as many as draws.

    Returns
    -------
    list of (Draw, list of dict)
        With the effect as `simulated_test` is given it.
    """
    sizes = posterior_sizes(*posterior, count)
    order = np.random.default_rng([count, *candidate.key.encode()]).permutation(count)
    return members_at(candidate, sizes[order], draws, features, measured, responses)


def members_at(candidate, sizes, draws, features, measured, responses):
    """Members with given sizes, a draw each; other arguments as of `extended_members`.

    Parameters
    ----------
    candidate : Candidate
    sizes : float64 array, shape (n_members,)
        In units of the visible one.

    Returns
    -------
    list of (Draw, list of dict)

    Notes
    -----
    Nominal parameters are conditioned on the measured features less what the effect adds in the mean at the member's
    own size, so a member with a large effect has other nominal parameters than one with a small effect. At the null
    size nothing is added: the member is the recalibrated one. By how much more the effect adds in one draw than in
    another is left out here; the simulation of the member has it. Parameters other than the size are those that the
    library gave the draw of that number: the tests are not asked about them.
    """
    added = np.concatenate([_at(response, sizes) for response in responses], axis=1)
    known = posterior_draws(draws, features, measured, added).draws
    return [
        (draw, [candidate.as_effect(candidate.values_at(float(size), number))])
        for number, (draw, size) in enumerate(zip(known, sizes, strict=True))
    ]


def posterior_sizes(sizes, weights, count):
    """Medians of ``count`` strata of equal probability of a size.

    Parameters
    ----------
    sizes, weights : float64 arrays, shape (n_sizes,)
        Rising, and the posterior's weights there: its density is taken as straight between them.
    count : int

    Returns
    -------
    float64 array, shape (count,)
        Rising.
    """
    fine = np.linspace(sizes[0], sizes[-1], _DENSITY_POINTS)
    density = np.interp(fine, sizes, weights)
    below = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    rising = np.concatenate([[True], np.diff(below) > 0.0])
    return np.interp((np.arange(count) + 0.5) / count, below[rising] / below[-1], fine[rising])


def _at(response, sizes):
    """Mean response at other sizes than its own, straight between them and nothing at the null size."""
    knots, first = np.unique(np.append(response.sizes, 0.0), return_index=True)
    means = np.concatenate([response.mean, np.zeros((1, response.mean.shape[1]))])[first]
    means[knots == 0.0] = 0.0
    return np.column_stack([np.interp(sizes, knots, column) for column in means.T])
