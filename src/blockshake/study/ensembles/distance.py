"""How far a curve is from an ensemble, in standard deviations of its noise and of the members' spread."""

import numpy as np


def distances(readings, curves, noise):
    """Distance of every curve from each ensemble that it is held against, the members from the others.

    Parameters
    ----------
    readings : float64 array, shape (n_curves, n_times, n_markers)
        Members as an instrument would read them, in their order, and after these any further curves [m]; NaN is a gap.
    curves : float64 array, shape (n_members, n_times, n_markers)
        Members; NaN, as after the end of a run, is no value [m].
    noise : float
        Standard deviation of a position read [m]; a displacement since the first reading has it twice.

    Returns
    -------
    float64 array, shape (n_curves, n_markers)
        Root mean square over the times of the difference from the mean of the members, over the standard deviation of
        a further reading of the ensemble. A member is left out of the ensemble that it is held against (leave one
        out). Infinite for a curve off members that are all alike, without noise; NaN without any time.

    Notes
    -----
    A distance has no end, where the share of the time within bounds has one: it tells 1 mm from 100 mm off a band that
    is thinner than the noise.
    """
    there = np.isfinite(curves)
    centre = np.nan_to_num(curves[0])  # near all of them, so that the squares below cancel little
    shifted = np.where(there, curves - centre, 0.0)
    count, total, square = there.sum(axis=0), shifted.sum(axis=0), (shifted**2).sum(axis=0)
    found = []
    for place, reading in enumerate(readings):
        own = shifted[place] if place < len(curves) else 0.0
        others = count - (there[place] if place < len(curves) else 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (total - own) / others
            spread = np.maximum(square - own**2 - others * mean**2, 0.0) / (others - 1)
            away = (reading - centre - mean) ** 2
            score = np.where(away == 0.0, 0.0, away / (spread * (1.0 + 1.0 / others) + 2.0 * noise**2))
        known = np.isfinite(reading) & (others > 1)
        with np.errstate(invalid="ignore"):
            found.append(np.sqrt(np.where(known, score, 0.0).sum(axis=0) / known.sum(axis=0)))
    return np.array(found)
