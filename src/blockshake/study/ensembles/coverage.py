"""Coverage: how much of a measured curve lies within an ensemble's bounds, never without its reference."""

import numpy as np
import xarray as xr

from blockshake.statistics.resampling import rank_chance
from blockshake.study.described import describe
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.distance import distances
from blockshake.study.ensembles.ensemble import ALONG_X, POSES, join_batches, relative_to_slab
from blockshake.study.ensembles.envelope import over_samples
from blockshake.study.ensembles.measured import compared_curves

REFERENCE_QUANTILES = (0.05, 0.5, 0.95)
_FEWEST_MEMBERS = 3
_NOISE_SEED = 0  # of the readings of the members
UNLIKELY = 0.05  # chance of a whole curve at or below which an ensemble does not fit
_DESCRIBED = {
    "coverage": ("fraction of the time that the measured curve is within the bounds", "1"),
    "reference": ("the same of the members, each in the bounds of the others", "1"),
    "member_coverage": ("fraction of the time that a member is within the bounds of the others", "1"),
    "distance": (
        "root mean square distance from the members, in standard deviations of noise and spread",
        "1",
    ),
    "member_distance": ("the same of a member from the others", "1"),
    "curve_probability": ("chance of a distance as large if the measured curve were one of the members", "1"),
    "band_width": ("upper minus lower bound, mean over time", "m"),
    "measured_peak": ("largest absolute measured displacement along x relative to the slab", "m"),
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
        From `gather_ensemble`; only completed and collapsed samples count.
    marker_noise : float
        Standard deviation of a measured marker's position [m].

    Returns
    -------
    xarray.Dataset
        Along the markers that both have, displacement along x, inertial frame: ``coverage(marker)`` of the measured
        curve in the bounds of all members; ``member_coverage(sample, marker)`` of each member, read with the same
        noise, in the bounds of the others; its ``reference(quantile, marker)``; ``distance(marker)`` of the measured
        curve and ``member_distance(sample, marker)`` as of `distances`; ``curve_probability(marker)``, the rank of the
        measured curve's distance among the members', from 1 / (n + 1) to 1; ``band_width(marker)`` [m], mean
        over time; and ``measured_peak(marker)`` [m], largest absolute displacement relative to the slab's marker, to
        hold the width against. All but the peak are NaN for fewer than three members: too few for a reference.

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
    measured curve wherever the band is thinner than the noise. There coverage says nothing at all, of any curve, and
    the distance decides.
    """
    read, members, curves, readings = compared_curves(measured, ensemble, marker_noise, _NOISE_SEED)
    markers = list(read["marker"].values)
    enough = len(curves) >= _FEWEST_MEMBERS
    by_curve = np.full((len(curves) + 1, len(markers)), np.nan)
    inside, width, (*member_coverage, _) = by_curve[-1], by_curve[-1], by_curve
    *members_away, away = by_curve
    if enough:
        lower, upper = np.fmin.reduce(curves, axis=0), np.fmax.reduce(curves, axis=0)
        inside, member_coverage = (
            share_inside(read.to_numpy(), lower, upper),
            members_inside(curves, readings),
        )
        every_reading = np.concatenate([readings, read.to_numpy()[None]])
        *members_away, away = distances(every_reading, curves, marker_noise)
        width = np.nanmean(upper - lower, axis=0)
    member_coverage = np.reshape(member_coverage, (len(curves), len(markers)))
    by_marker = {"marker": markers}
    by_member = xr.DataArray(
        member_coverage, dims=("sample", "marker"), coords={"sample": members["sample"], **by_marker}
    )
    probabilities = xr.DataArray(
        list(REFERENCE_QUANTILES), dims="quantile", coords={"quantile": list(REFERENCE_QUANTILES)}
    )
    member_distance = by_member.copy(data=np.reshape(members_away, by_member.shape))
    result = xr.Dataset(
        {
            "coverage": ("marker", inside),
            "reference": over_samples(by_member, probabilities),
            "member_coverage": by_member,
            "distance": ("marker", away),
            "member_distance": member_distance,
            "curve_probability": ("marker", rank_chance(away, members_away) if enough else away * np.nan),
            "band_width": ("marker", width),
            "measured_peak": ("marker", _measured_peak(measured, members.attrs["slab_marker"], markers)),
        },
        coords=by_marker,
    )
    describe(result, _DESCRIBED)
    result.attrs = {
        **ensemble.attrs,
        "title": "coverage of a measured curve by an ensemble, with its leave-one-out reference",
        "synthetic": int(measured.attrs.get("synthetic", 0)),
        "counted": members.sizes["sample"],
        "marker_noise": float(marker_noise),
        "noise_seed": _NOISE_SEED,
    }
    return result


def is_likely(chance, members):
    """Whether a curve of some chance [1] may be one of the ensemble: beyond 5 %, and the lowest that its members tell.

    >>> is_likely(0.09, 50), is_likely(1.0 / 11.0, 10)
    (True, False)
    """
    return bool(chance > max(UNLIKELY, 1.0 / (1.0 + members)))


def relative_width(comparison, peak):
    """Mean width of the band of a `coverage` over the peak of the measured curve [1].

    ``peak``: of the displacement relative to the slab over the simulated window [m].
    """
    return comparison["band_width"] / peak


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


def _measured_peak(measured, slab_marker, markers):
    displacement = measured["marker_displacement"].sel(axis="x", drop=True)
    slab_marker = measured.attrs.get("slab_marker", slab_marker)
    if slab_marker not in displacement["marker"].values:
        return np.full(len(markers), np.nan)
    relative = relative_to_slab(displacement, slab_marker).sel(marker=markers)
    return np.abs(relative).max("time").to_numpy()
