"""Repeated readings: a copy of a test is no new evidence."""

import hashlib

import numpy as np


def without_repeats(tests):
    """Tests whose readings no earlier one of them has.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset

    Returns
    -------
    dict of str to xarray.Dataset
        In the order given; of tests with the same markers' displacements, gaps included, the first stays.

    Notes
    -----
    Noise makes two tests differ in every reading, however alike they are. Equal readings are one test under two names,
    and evidence that counts them twice would be as sure of one test as of two.
    """
    kept = {}
    for name, test in tests.items():
        ordered = test["marker_displacement"].transpose("time", "marker", "axis").sortby("marker")
        readings = np.round(ordered.to_numpy(), 12) + 0.0  # no minus zero
        digest = hashlib.sha256(np.where(np.isnan(readings), np.nan, readings).tobytes()).hexdigest()
        kept.setdefault(digest, name)
    return {name: tests[name] for name in kept.values()}
