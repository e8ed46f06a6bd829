"""The size of the cause that was found, from more draws of it than a library has of every candidate."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.inference.calibration import as_case, size_error
from blockshake.diagnosis.inference.decision import CauseSize
from blockshake.diagnosis.inference.library_scores import runs_of, score_library
from blockshake.diagnosis.inference.posterior import calibrated_weights, parameter_estimates
from blockshake.diagnosis.libraries.candidates import effect_of


def library_of_cause(tables, further, key):
    """Libraries with one candidate alone: their own nominal runs, and all runs with the candidate.

    Parameters
    ----------
    tables, further : list of dict of str to xarray.Dataset
        By test and solver, features from `library`: of all candidates, and of more draws of this one.
    key : str
        Of the candidate.

    Returns
    -------
    ScaledLibrary
        Its scales are those of the libraries of all candidates.
    """
    narrow = [
        {
            model: xr.concat([runs_of(table), runs_of(more[model], key)], dim="run").assign_attrs(model=model)
            for model, table in by_model.items()
        }
        for by_model, more in zip(tables, further, strict=True)
    ]
    return score_library(narrow, [effect_of(key)])


def without_second(library, features, decision):
    """Features of measured tests less what the second effect of a combination adds; any other decision leaves them.

    Parameters
    ----------
    library : ScoreLibrary
        Of all candidates.
    features : list of float64 array, shape (n_features,)
        Measured, by test, tamed.
    decision : Decision

    Returns
    -------
    list of float64 array, shape (n_features,)
        Less the mean over the solvers of the second effect's response at the size that the decision gives it.
    """
    if decision.decision != "combination":
        return features
    second = decision.causes[1]
    key, size = decision.places[second], decision.sizes[second]
    place = int(np.argmin(np.abs(library.grid(key) - size)))
    added = [
        [library.evidence(test, model).responses[key].mean[place] for model in library.models]
        for test in range(len(features))
    ]
    return [own - np.mean(more, axis=0) for own, more in zip(features, added, strict=True)]


def size_of_cause(library, features):
    """`CauseSize`: posterior of the size, and the parameters with it.

    Parameters
    ----------
    library : ScoreLibrary
        From `library_of_cause`.
    features : list of float64 array, shape (n_features,)
        Measured, by test, tamed; of a combination as from `without_second`.
    """
    (key,) = library.candidates
    scores = library.score(features)
    error = size_error(effect_of(key), _left_out(library, key))
    posterior = calibrated_weights(scores.sizes[key], scores.weights[key], error)
    return CauseSize(
        key=key,
        sizes=scores.sizes[key].tolist(),
        posterior=posterior.tolist(),
        error=error,
        draws=len(library.sizes[library.models[0]][key]),
        parameters=parameter_estimates(effect_of(key), scores.sizes[key], posterior),
    )


def _left_out(library, key):
    """Cases of every draw with the candidate, judged by the others."""
    cases = []
    for model in library.models:
        by_test = [test[model][key] for test in library.tamed]
        for draw, size in enumerate(library.sizes[model][key]):
            scores = library.score([runs[draw] for runs in by_test], model, draw)
            cases.append(as_case(scores, key, float(size)))
            library.forget(model, draw)
    return cases
