"""Ranking of joints, curves and tests by the misfit of the nominal ensemble."""

from typing import NamedTuple

import numpy as np


class WorstCurves(NamedTuple):
    """Curves that the nominal ensemble predicts worst.

    Attributes
    ----------
    names : list of str
        From the worst down.
    known : int
        Curves with a score.
    below_reference : int
        Curves with a coverage below the 5 % quantile of the members'.
    """

    names: list
    known: int
    below_reference: int


def worst_joints(misfit, most):
    """Joints with the largest residuals of a `misfit`, at most so many, from the lowest up."""
    residual = np.abs(misfit["residual"]).max(("test", "phase", "quantity", "side")).fillna(0.0).to_numpy()
    chosen = np.sort(np.argsort(-residual, kind="stable")[:most])
    return [str(misfit["joint"].values[place]) for place in chosen]


def worst_curves(misfit, most):
    """`WorstCurves` of a `misfit`, at most so many: by score over the median of the members' leave-one-out scores."""
    known = misfit.dropna("curve", subset=["crps"])
    excess = (known["crps"] / known["crps_reference"].sel(reference=0.5)).to_numpy()
    chosen = np.argsort(-excess, kind="stable")[:most]
    low = known["coverage"] < known["coverage_reference"].sel(reference=0.05)
    return WorstCurves([str(one) for one in known["curve"].values[chosen]], len(excess), int(low.sum()))


def strongest_test(readings, body):
    """Name of the test with the largest measured drift of a body."""
    drift = np.abs(readings["drift"].sel(body=body)).max("time")
    return str(drift["test"].values[int(np.nanargmax(drift.to_numpy()))])
