"""The features that speak for a candidate: measured, as the nominal model has them, and as the extended one has."""

import numpy as np
import xarray as xr


def deciding_features(library, scales, readings, names, candidate):
    """Standardised residuals of every feature, without and with a candidate.

    Parameters
    ----------
    library : ScoreLibrary
    scales : list of FeatureScale
        By test.
    readings : list of xarray.Dataset
        Measured, by test, from `read_off`.
    names : sequence of str
        Of the tests.
    candidate : CandidateScore
        At its best size, by the solver that predicts best.

    Returns
    -------
    xarray.Dataset
        Along ``row``, the features of all tests by falling ``weight``: ``nominal`` and ``extended``, measured less
        predicted mean in the predicted standard deviation [1]; ``weight``, by how much the candidate lowers the square
        of that, each feature by itself; ``value`` [in ``unit(row)``]. Coordinates ``test``, ``feature``, ``unit``.
    """
    rows = []
    for test, (scale, reading, name) in enumerate(zip(scales, readings, names, strict=True)):
        evidence = library.evidence(test, candidate.model)
        response = evidence.responses[candidate.key]
        place = int(np.argmin(np.abs(response.sizes - candidate.size)))
        spread = np.sqrt(np.diag(evidence.covariance))
        residual = scale.tamed(reading) - evidence.mean
        nominal = residual / spread
        extended = (residual - response.mean[place]) / np.hypot(spread, response.deviation[place])
        raw = reading.sel(feature=list(scale.names))
        for column, feature in enumerate(scale.names):
            rows.append(
                (
                    nominal[column] ** 2 - extended[column] ** 2, nominal[column], extended[column],
                    float(raw["value"][column]), str(raw["unit"].values[column]), name, feature,
                )
            )  # fmt: skip
    rows.sort(key=lambda row: -row[0])
    weight, nominal, extended, value, unit, test, feature = map(np.array, zip(*rows, strict=True))
    return xr.Dataset(
        {
            "weight": ("row", weight),
            "nominal": ("row", nominal),
            "extended": ("row", extended),
            "value": ("row", value),
        },
        {"unit": ("row", unit), "test": ("row", test), "feature": ("row", feature)},
        {"candidate": candidate.key, "size": candidate.size, "model": candidate.model},
    )
