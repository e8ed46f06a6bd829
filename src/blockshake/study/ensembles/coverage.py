"""Coverage: how much of a measured curve lies within an ensemble's bounds, never without its reference."""

import numpy as np
import xarray as xr

from blockshake.measurement.motion.compared_curves import curves_along_x
from blockshake.measurement.sensors.markers import noisy_reading
from blockshake.statistics.intervals import sample_quantiles
from blockshake.statistics.resampling import rank_chance
from blockshake.statistics.scores import FEWEST
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.ensemble import ALONG_X, POSES, describe, join_batches
from blockshake.study.ensembles.envelope import counted_samples

REFERENCE_QUANTILES = (0.05, 0.5, 0.95)
_NOISE_SEED = 0  # of the readings of the members
UNLIKELY = 0.05  # chance of a whole curve at or below which an ensemble does not fit
_DESCRIBED = {
    "coverage": ("fraction of the time that the measured curve is within the bounds", "1"),
    "reference": ("the same of the members, each in the bounds of the others", "1"),
    "distance": (
        "root mean square distance from the members, in standard deviations of noise and spread",
        "1",
    ),
    "curve_probability": ("chance of a distance as large if the measured curve were one of the members", "1"),
    "quantile": ("probability of a smaller value", "1"),
}


def coverage_of_case(named, base, batches):
    """`coverage` of the test that a case is compared with, ``named`` by ``campaign``, a folder, and ``test``.

    ``base``: file from `measured_input`; ``batches``: files of the case's samples.
    """
    measured, marker_noise = measured_on_clock(named, base)
    return coverage(measured, join_batches(batches, POSES, ALONG_X), marker_noise)


def coverage(measured, ensemble, marker_noise):
    """Fraction of the time that a measured curve lies within the bounds, and the same of the members.

    Parameters
    ----------
    measured : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame, relative to the first
        reading; NaN is a gap. Its clock is the ensemble's.
    ensemble : xarray.Dataset
        From `join_batches`; only completed and collapsed samples count.
    marker_noise : float
        Standard deviation of a measured marker's position [m].

    Returns
    -------
    xarray.Dataset
        Along the markers that both have, displacement along x, inertial frame: ``coverage(marker)`` of the measured
        curve in the bounds of all members; ``reference(quantile, marker)`` of each member, read with the same noise, in
        the bounds of the others; ``distance(marker)`` of the measured curve, from `distances`; and
        ``curve_probability(marker)``, the rank of that distance among the members', from 1 / (n + 1) to 1. All are
        NaN for fewer than three members: too few for a reference.

    Raises
    ------
    InputError
        No members, no marker or no time in common.

    Notes
    -----
    Coverage alone has no error rate: even a further run of the same ensemble leaves the band now and
    then, for stretches as long as the motion's correlation. The reference, leave-one-out over
    the members, carries that correlation. Its bounds come from one member less than the measured
    curve's, which makes it a little lower: cautious, as 1 / n. A noise-free reference would fail every
    measured curve wherever the band is thinner than the noise. There coverage means nothing at all, of any curve, and
    the distance decides.
    """
    read, members, curves, readings = compared_curves(measured, ensemble, marker_noise, _NOISE_SEED)
    markers = list(read["marker"].values)
    inside = probability = np.full(len(markers), np.nan)
    member_coverage = np.full((len(curves), len(markers)), np.nan)
    away = np.full((len(curves) + 1, len(markers)), np.nan)  # of the members, and of the measured curve
    if len(curves) >= FEWEST:
        lower, upper = np.fmin.reduce(curves, axis=0), np.fmax.reduce(curves, axis=0)
        inside = share_inside(read.to_numpy(), lower, upper)
        member_coverage = members_inside(curves, readings)
        away = distances(np.concatenate([readings, read.to_numpy()[None]]), curves, marker_noise)
        probability = rank_chance(away[-1], away[:-1])
    result = xr.Dataset(
        {
            "coverage": ("marker", inside),
            "reference": (("quantile", "marker"), sample_quantiles(member_coverage, REFERENCE_QUANTILES)),
            "distance": ("marker", away[-1]),
            "curve_probability": ("marker", probability),
        },
        coords={"quantile": list(REFERENCE_QUANTILES), "marker": markers},
    )
    describe(result, _DESCRIBED)
    result.attrs = {
        **ensemble.attrs,
        "title": "coverage of a measured curve by an ensemble, with its leave-one-out reference",
        "synthetic": int(measured.attrs.get("synthetic", 0)),
        "counted": members.sizes["sample"],
        "marker_noise": float(marker_noise),
    }
    return result


def compared_curves(measured, ensemble, marker_noise, seed):
    """Displacement along x of a measured curve and of an ensemble at the same times, inertial frame [m].

    Arguments and errors are those of `coverage`; ``seed`` is of the noise. Returned: the measured curve (time,
    marker), the samples that count, and their curves without and with a marker's noise (n_samples, n_times, n_markers).
    """
    members = counted_samples(ensemble)
    read, curves = curves_along_x(measured, members)
    curves, generator = curves.to_numpy(), np.random.default_rng(seed)
    readings = [noisy_reading(curve, marker_noise, generator) for curve in curves]
    return read, members, curves, np.reshape(readings, curves.shape)


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
    away_of_curves = []
    for row, reading in enumerate(readings):
        member = shifted[row] if row < len(curves) else 0.0
        others = count - (there[row] if row < len(curves) else 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (total - member) / others
            spread = np.maximum(square - member**2 - others * mean**2, 0.0) / (others - 1)
            away = (reading - centre - mean) ** 2
            score = np.where(away == 0.0, 0.0, away / (spread * (1.0 + 1.0 / others) + 2.0 * noise**2))
        known = np.isfinite(reading) & (others > 1)
        with np.errstate(invalid="ignore"):
            away_of_curves.append(np.sqrt(np.where(known, score, 0.0).sum(axis=0) / known.sum(axis=0)))
    return np.array(away_of_curves)


def is_likely(chance, members):
    """Whether a curve of some chance [1] may be one of the ensemble: beyond 5 %, and the lowest that its members tell.

    >>> is_likely(0.09, 50), is_likely(1.0 / 11.0, 10)
    (True, False)
    """
    return bool(chance > max(UNLIKELY, 1.0 / (1.0 + members)))


def share_inside(curve, lower, upper):
    """Share of the times at which curve and band exist that the curve is inside, over the first axis."""
    known = np.isfinite(curve) & np.isfinite(lower)
    with np.errstate(invalid="ignore"):
        return (known & (curve >= lower) & (curve <= upper)).sum(axis=0) / known.sum(axis=0)


def members_inside(curves, readings):
    """Share of the times that each curve, as read, is within the band of the others: (n_curves, ...).

    ``curves``, ``readings`` (n_curves, n_times, ...): those that span the band, and as an instrument would read them.
    """
    rising = np.sort(curves, axis=0)[:2]
    falling = -np.sort(-curves, axis=0)[:2]
    inside = []
    for curve, reading in zip(curves, readings, strict=True):
        # the bound of the others is the second value where this member is the first
        lower = np.where(curve == rising[0], rising[1], rising[0])
        upper = np.where(curve == falling[0], falling[1], falling[0])
        inside.append(share_inside(reading, lower, upper))
    return np.array(inside)
