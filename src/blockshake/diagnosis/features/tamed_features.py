"""Features of measured and simulated tests on one scale, ready for Gaussian comparison."""

from dataclasses import dataclass

import numpy as np

from blockshake.diagnosis.features.feature_scales import signed_log
from blockshake.errors import InputError

_SMALLEST_SPREAD = 1e-6  # of a feature's largest magnitude over the draws: with less spread it tells nothing


@dataclass(frozen=True)
class FeatureScale:
    """Centre and spread of the features of a test over all nominal draws.

    Attributes
    ----------
    names : tuple of str
        Of the features that differ between nominal draws.
    centre, spread : float64 array, shape (n_features,)
        After `signed_log` of the feature table, which tames the heavy tails of peaks and residuals.
    """

    names: tuple
    centre: np.ndarray
    spread: np.ndarray

    def tamed(self, reading):
        """Features of a reading, or of many along a first dimension, float64 array, shape (..., n_features).

        Raises
        ------
        InputError
            A feature that the reading lacks: its sensors are not those of the library.
        """
        known = set(reading["feature"].values.tolist())
        for name in self.names:
            if name not in known:
                raise InputError("features", name, "expected the features of the library")
        values = signed_log(reading["value"].sel(feature=list(self.names))).transpose(..., "feature")
        return (values.to_numpy() - self.centre) / self.spread


def feature_scale(nominal):
    """Scale of a test's features.

    Parameters
    ----------
    nominal : sequence of xarray.Dataset
        Features of nominal draws, ``value(run, feature)``, one dataset a solver.
    """
    first = [str(name) for name in nominal[0]["feature"].values]
    names = [name for name in first if all(name in one["feature"].values for one in nominal)]
    pool = np.concatenate(
        [signed_log(one["value"].sel(feature=names)).transpose(..., "feature").to_numpy() for one in nominal]
    )
    centre, spread = pool.mean(axis=0), pool.std(axis=0, ddof=1)
    told = spread > _SMALLEST_SPREAD * np.abs(pool).max(axis=0)
    return FeatureScale(
        tuple(name for name, kept in zip(names, told, strict=True) if kept), centre[told], spread[told]
    )
