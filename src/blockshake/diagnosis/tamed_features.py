"""Features of measured and simulated tests on one scale, ready for Gaussian comparison."""

import numpy as np

from blockshake.diagnosis.feature_scales import signed_log

_SAME = 1e-6  # of a feature's largest magnitude over the draws: with less spread it tells nothing


def tame(measured, libraries):
    """Features of a test and of its libraries, centred and scaled by all nominal draws together.

    Parameters
    ----------
    measured : xarray.Dataset
        From `features`.
    libraries : dict of str to dict of str to xarray.Dataset
        From `library`, by model and then by candidate; ``nominal`` is the one without.

    Returns
    -------
    names : list of str, length n_features
        Those that measurement and libraries have, and that differ between nominal draws.
    measured : float64 array, shape (n_features,)
    tamed : dict of str to dict of str to float64 array, shape (n_draws, n_features)
        As ``libraries``.

    Notes
    -----
    First `signed_log` of the feature table, which tames the heavy tails of peaks and residuals.
    """
    names = [str(name) for name in measured["feature"].values]
    for runs in libraries.values():
        there = set(runs["nominal"]["feature"].values.tolist())
        names = [name for name in names if name in there]
    values = {
        model: {key: _values(one, names) for key, one in runs.items()} for model, runs in libraries.items()
    }
    pool = np.concatenate([runs["nominal"] for runs in values.values()])
    centre, spread = pool.mean(axis=0), pool.std(axis=0, ddof=1)
    told = spread > _SAME * np.abs(pool).max(axis=0)

    def scaled(array):
        return (array[..., told] - centre[told]) / spread[told]

    return (
        [name for name, kept in zip(names, told, strict=True) if kept],
        scaled(_values(measured, names)),
        {model: {key: scaled(array) for key, array in runs.items()} for model, runs in values.items()},
    )


def _values(runs, names):
    return signed_log(runs["value"].sel(feature=names)).transpose(..., "feature").to_numpy()
