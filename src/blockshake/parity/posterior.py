"""Faults as unknowns of linear equations, each tied to zero by what a sound sensor may have."""

import numpy as np

VAGUE = 1e3  # times a tolerance: as good as unknown


def posterior(equations, spread):
    """Mean and covariance of the unknowns, shapes (n,), (n, n).

    Parameters
    ----------
    equations : object
        Attributes ``normal`` (n, n), ``right`` (n,) and ``variance`` of a reading.
    spread : float64 array, shape (n,)
        Standard deviation of each unknown before anything is read.
    """
    information = equations.normal / equations.variance + np.diag(1.0 / spread**2)
    covariance = np.linalg.inv(information)
    return covariance @ (equations.right / equations.variance), covariance


def data_alone(mean, covariance, spread):
    """Estimate and covariance of some unknowns with their own prior made vague; the others keep theirs."""
    information = np.linalg.inv(covariance)
    right = information @ mean
    vague = information - np.diag(1.0 / spread**2) + np.diag(1.0 / (VAGUE * spread) ** 2)
    own = np.linalg.inv(vague)
    return own @ right, own
