"""Repeated readings: a copy of a test is no new evidence."""

import hashlib

import numpy as np

from blockshake.measurement.campaigns.campaign import load_test


def without_repeats(campaign, names):
    """Names of tests whose readings no earlier one of them has.

    Parameters
    ----------
    campaign : Campaign
    names : sequence of str

    Returns
    -------
    list of str
        In the order given; of tests with the same markers' displacements, gaps included, the first stays.

    Notes
    -----
    Noise makes two tests differ in every reading, however alike they are. Equal readings are one test under two names,
    and evidence that counts them twice would be as sure of one test as of two.
    """
    seen, kept = set(), []
    for name in names:
        test = load_test(campaign, name)
        ordered = test["marker_displacement"].transpose("time", "marker", "axis").sortby("marker")
        readings = np.round(ordered.to_numpy(), 12) + 0.0  # no minus zero
        digest = hashlib.sha256(np.where(np.isnan(readings), np.nan, readings).tobytes()).hexdigest()
        if digest not in seen:
            seen.add(digest)
            kept.append(name)
    return kept
