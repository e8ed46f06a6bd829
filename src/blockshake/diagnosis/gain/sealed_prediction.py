"""A sealed test and the members of several ensembles that predict it, feature by feature on one scale."""

from dataclasses import dataclass

import numpy as np

from blockshake.diagnosis.features.tamed_features import feature_scale


@dataclass(frozen=True)
class SealedTest:
    """One test that nothing was fitted to.

    Attributes
    ----------
    name : str
    features : list of str, length n_features
    measured : float64 array, shape (n_features,)
        Tamed, in units of the nominal spread.
    members : dict of str to dict of str to float64 array, shape (n_members, n_features)
        By kind (``nominal``, ``recalibrated``, ``extended``, ``discrepancy``) and solver.
    """

    name: str
    features: list
    measured: np.ndarray
    members: dict


def tamed_test(name, measured, readings):
    """`SealedTest`: a test and its ensembles on one scale; an open one for the discrepancy as well.

    Parameters
    ----------
    name : str
    measured : xarray.Dataset
        From `read_off`.
    readings : dict of str to dict of str to xarray.Dataset
        By kind and solver: ``value(..., feature)``; ``nominal`` is among them and gives the scale.
    """
    scale = feature_scale(list(readings["nominal"].values()))
    members = {
        kind: {model: scale.tamed(runs) for model, runs in by_model.items()}
        for kind, by_model in readings.items()
    }
    return SealedTest(name, list(scale.names), scale.tamed(measured), members)


def family(feature):
    """Family of a feature by where it is read: ``joint1`` and so on, ``base``, or ``top``."""
    head = feature.partition(".")[0]
    return head if head.startswith("joint") or head == "base" else "top"
