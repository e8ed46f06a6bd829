"""Fragilities over an intensity from samples that are each shaken once, by a record as it is or scaled to a level."""

from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from scipy.special import expit, gammaincinv, ndtr, ndtri

from blockshake.dynamics.intensity import motion_figures
from blockshake.dynamics.load_motion import scaled
from blockshake.dynamics.record_set import DrawnMotions, Intensity
from blockshake.dynamics.system import FALLEN
from blockshake.geometry.structure import load_structure
from blockshake.quantities import FACTOR
from blockshake.statistics.intervals import CONFIDENCE
from blockshake.store import load_made
from blockshake.study.ensembles.drift_limits import drift_limits, slip_limits
from blockshake.study.ensembles.ensemble import describe
from blockshake.study.ensembles.envelope import BOUNDS, counted_samples
from blockshake.study.fragility.capacity import estimate_capacity
from blockshake.study.fragility.fragility import ESTIMATES, POINTS

_DRAWN = 2000  # of the parameters of a regression
_STILL = 1e-4  # m, the noise of a marker: a sample that moves less tells nothing of a line
_STEPS = 60  # of a bisection, and of Newton's method
# in the logarithm of the intensity, from the middle of the samples to where no level is looked for
_FAR = 20.0
_DESCRIBED = {
    "intensity": "measure of the motion of the sample",
    "fine_intensity": "measure of the motion",
    "median": "intensity at which half of the samples do not pass",
    "safe": "intensity at which 5 % of the samples do not pass",
    "dispersion": "standard deviation of the logarithm of the intensity at which a sample does not pass",
    "curve": "probability of not passing",
    "demand": "largest displacement along x relative to the slab, of the marker that comes nearest to its limit",
    "largest_drift": "displacement or slip that counts as not passing",
    "peak_acceleration": "peak ground acceleration along x of the motion of the sample",
    "fell": "1 where the sample collapsed, or still fell as the window ended",
}
_UNITS = {
    "dispersion": "1",
    "curve": "1",
    "demand": "m",
    "largest_drift": "m",
    "peak_acceleration": "m/s2",
    "fell": "1",
}


class Cloud(NamedTuple):
    """Probability of not passing over the intensity, by regression; numbers, or arrays (n,) of drawn parameters."""

    # intercept, slope, deviation: of the logarithm of the demand, over that of its limit, on the logarithm of
    # the intensity
    intercept: float
    slope: float
    deviation: float
    # fall_intercept, fall_slope: of the logit of the probability of a fall on the same; minus infinity and 0
    # where nothing fell
    fall_intercept: float
    fall_slope: float
    middle: float  # mean logarithm of the intensities

    def probability(self, level):
        """Probability of a fall or of a demand above its limit at an intensity, or intensities [1]."""
        log = np.log(level)
        exceeds = ndtr((self.intercept + self.slope * log) / self.deviation)
        falls = expit(self.fall_intercept + self.fall_slope * log)
        return falls + (1.0 - falls) * exceeds

    def level(self, probability):
        """Intensity with this probability; 0 or infinity where the probability stays above or below it."""
        low, high = np.broadcast_arrays(self.middle - _FAR, self.middle + _FAR + 0.0 * self.slope)
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            below = self.probability(np.exp(middle)) < probability
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        found = np.where(high >= self.middle + _FAR - 1e-6, np.inf, np.exp(high))
        return np.where(low <= self.middle - _FAR + 1e-6, 0.0, found)

    @property
    def median(self):
        """Intensity at which half do not pass."""
        return self.level(0.5)

    @property
    def dispersion(self):
        """Half the logarithm of the ratio of the intensities at 84 and 16 %: the deviation of a lognormal curve [1]."""
        with np.errstate(invalid="ignore", divide="ignore"):
            spread = 0.5 * (np.log(self.level(ndtr(1.0))) - np.log(self.level(ndtr(-1.0))))
        return np.where(np.isnan(spread), np.inf, spread)


def fit_cloud(intensity, demand, fell, limit, weight=1.0):
    """`Cloud` of samples, and many whose parameters are drawn as the samples leave them open.

    Parameters
    ----------
    intensity : float64 array, shape (n_samples,)
        Above 0.
    demand : float64 array, shape (n_samples,)
        That of samples that fell, or stay within a tenth of a millimetre, is not used [m].
    fell : bool array, shape (n_samples,)
    limit : float64 array, shape (n_samples,) or ()
        Demand that counts as not passing [m].
    weight : float
        Share of the samples that are independent of each other [1]: of samples that come m times, 1 / m.

    Returns
    -------
    fitted, drawn : Cloud
        Numbers, and arrays (2000,); NaN where fewer than three samples of different intensities move and stand.

    Notes
    -----
    Jalayer and Cornell (2009), Earthquake Eng. Struct. Dyn. 38: least squares of the logarithms for samples that stand,
    of constant deviation; a logistic regression for the falls as in Jalayer et al. (2017), Soil Dyn. Earthquake Eng.
    The parameters of the least squares are drawn from their posterior with the prior 1 / variance, whose quantiles of
    intercept and slope are Student's; those of the logistic regression from the normal distribution of their
    information. The regression is Firth's (1993), which stays finite where one intensity parts falls from the others.
    The draws are the same for all samples.
    """
    log, fell = np.log(intensity), np.asarray(fell, dtype=bool)
    used = ~fell & (demand > _STILL)
    x, y = log[used], np.log((demand / limit)[used])
    size, middle = weight * len(x), float(np.mean(log)) if len(log) else np.nan
    squares, freedom = weight * float(((x - x.mean()) ** 2).sum()) if len(x) else 0.0, size - 2.0
    if freedom < 1.0 or squares == 0.0:
        return Cloud(*np.full(6, np.nan)), Cloud(*np.full((6, _DRAWN), np.nan))
    slope = float(weight * (x - x.mean()) @ y / squares)
    deviation = float(np.sqrt(weight * ((y - y.mean() - slope * (x - x.mean())) ** 2).sum() / freedom))
    bits = np.random.PCG64(1).random_raw(5 * _DRAWN).reshape(5, _DRAWN)
    chances = ((bits >> np.uint64(11)) + 0.5) * 2.0**-53
    scores = ndtri(chances[:4])
    deviations = deviation * np.sqrt(0.5 * freedom / gammaincinv(0.5 * freedom, chances[4]))
    slopes = slope + deviations * scores[0] / np.sqrt(squares)
    means = y.mean() + deviations * scores[1] / np.sqrt(size)
    if not fell.any():
        falls, fallen = (-np.inf, 0.0), (np.full(_DRAWN, -np.inf), np.zeros(_DRAWN))
    else:
        falls, covariance = logistic(log, fell)
        fallen = falls[:, None] + np.linalg.cholesky(covariance / weight) @ scores[2:]
    fitted = Cloud(y.mean() - slope * x.mean(), slope, deviation, *falls, middle)
    return fitted, Cloud(means - slopes * x.mean(), slopes, deviations, *fallen, middle)


def logistic(x, event):
    """Intercept and slope of the logit of an event's probability, and their covariance matrix.

    Parameters
    ----------
    x : float64 array, shape (n,)
    event : bool array, shape (n,)

    Notes
    -----
    Firth (1993), Biometrika 80: the score with Jeffreys's prior, ``X' (y - p + h (1/2 - p))`` with the leverages ``h``.
    """
    design, answer = np.column_stack([np.ones_like(x), x - x.mean()]), np.zeros(2)
    for _ in range(_STEPS):
        chance = expit(design @ answer)
        weight = chance * (1.0 - chance)
        covariance = np.linalg.inv(design.T @ (weight[:, None] * design))
        leverage = weight * np.einsum("ij,jk,ik->i", design, covariance, design)
        step = covariance @ (design.T @ (event - chance + leverage * (0.5 - chance)))
        step *= min(1.0, 5.0 / np.abs(design @ step).max())
        answer = answer + step
        if np.abs(step).max() < 1e-10:
            break
    shift = np.array([[1.0, -x.mean()], [0.0, 1.0]])
    return shift @ answer, shift @ covariance @ shift.T


def cloud_of_case(samples, case, seed, largest_drift):
    """Intensity and demand of the samples of a case that draw motions, and both fragilities.

    Parameters
    ----------
    samples : path
        File from `sample_figures`.
    case : dict
        ``structure``, ``motion``, ``scale``, ``baseline`` and ``intensity`` of the configuration.
    seed : int
        The design.
    largest_drift : float, dict or None
        `drift_limits` and `slip_limits`.

    Returns
    -------
    xarray.Dataset
        By counted ``sample``: ``record``, ``intensity``, ``peak_acceleration`` [m/s2], ``demand`` and
        ``largest_drift`` [m] of the marker that comes nearest to the limit of its block, or of a joint, ``fell``. By
        ``fit``: ``median``, ``dispersion``, ``safe``, each with its ``_interval(fit, bound)``, and
        ``curve(fit, fine_intensity)`` with its limits; NaN where the samples do not tell. ``regression`` is
        `fit_cloud`; ``counts`` the lognormal curve of largest likelihood of passing and not passing, Eq. (11) of Baker
        (2015), Earthquake Spectra 31. Attributes: ``measure``, ``period``, number of ``levels`` and of ``records``,
        ``weight`` of a sample in the limits, and ``slope`` and ``intercept`` of the `Cloud`.

    Notes
    -----
    Passing or not at one intensity tells that a capacity lies above or below it. The likelihood of such bounds,
    `fit_capacity`'s, is Baker's product of binomials. Samples that draw the same record at the same level count
    together as one in all limits, since records differ by more than the sampled variables do.
    """
    counted = counted_samples(load_made(samples))
    structure = load_structure(case["structure"])
    shaken = shaken_by(counted, case, seed)
    demand, limit = _nearest(counted, structure, largest_drift)
    fell = np.isin(counted["status"].values, FALLEN)
    result, cloud = fragilities(shaken, demand, fell, limit)
    peaks = [motion_figures(motion)["peak_acceleration"] for motion in shaken.motions]
    by_sample = {
        "intensity": shaken.intensity,
        "peak_acceleration": peaks,
        "demand": demand,
        "largest_drift": limit,
    }
    for name, values in (by_sample | {"fell": fell.astype(int)}).items():
        result[name] = "sample", values
    record = ("sample", [one.name for one in shaken.records], {"long_name": "motion of the sample"})
    result = result.assign_coords(sample=counted["sample"], record=record)
    unit = "m/s" if shaken.target.measure == "pgv" else "m/s2"
    describe(result, {name: (words, _UNITS.get(name, unit)) for name, words in _DESCRIBED.items()})
    result.attrs = {
        "title": "fragility over the intensity of drawn motions",
        "measure": shaken.target.measure,
        "period": shaken.target.period or 0.0,
        "levels": len(shaken.target.levels),
        "records": len({one.name for one in shaken.records}),
        "weight": shaken.weight,
        "slope": float(cloud.slope),
        "intercept": float(cloud.intercept),
        "confidence": CONFIDENCE,
    }
    return result


def _nearest(counted, structure, given):
    """Largest displacement along x, or slip, of each sample and its limit, float64 (n_samples,) [m], of the marker or
    joint that has the largest share of the limit of its block or of its own; ``given``: of `drift_limits`."""
    markers = [one for one in structure.file.markers if not structure.driven[structure.carriers([one])[0]]]
    peak = counted["peak"].sel(frame="slab", marker=[one.name for one in markers], drop=True)
    slips = slip_limits(structure, given)
    slip = counted["joint_slip"].sel(joint=list(map("-".join, slips)), drop=True).transpose("sample", "joint")
    peak = np.hstack([peak.transpose("sample", "marker").to_numpy(), slip.to_numpy()])
    limit = [*drift_limits(structure, given)[structure.carriers(markers)], *slips.values()]
    limit = np.broadcast_to(limit, peak.shape)
    nearest = np.arange(len(peak)), np.argmax(np.nan_to_num(peak / limit), axis=1)
    return peak[nearest], limit[nearest]


class Shaken(NamedTuple):
    """Motions by which samples were shaken, in their order, before any heading turns them."""

    target: Intensity
    records: list  # of SetRecord
    motions: list  # of GroundMotion
    intensity: np.ndarray  # float64 (n_samples,); in the unit of the measure

    @property
    def weight(self):
        """Share of the samples that are independent [1]: those of the same record at the same level count as one."""
        return len(set(self.records)) / len(self.records) if self.records else 1.0


def shaken_by(samples, case, seed):
    """`Shaken` of samples of `sample_figures` of a case, a mapping, that draws motions by the design's ``seed``."""
    drawn, values = DrawnMotions.of(case), samples["parameter_value"].to_pandas()
    records = [drawn.draw(sample, seed) for sample in samples["sample"].values]
    factors = values.get(FACTOR, pd.Series(1.0, values.index)).to_numpy()
    own = [drawn.motion(record) for record in records]
    measures = [case["scale"] * one.level if one.level else drawn.intensity.of(motion)
            for one, motion in zip(records, own, strict=True)]  # fmt: skip
    motions = [scaled(motion, factor, motion.name) for motion, factor in zip(own, factors, strict=True)]
    return Shaken(drawn.intensity, records, motions, factors * np.array(measures))


def fragilities(shaken, demand, fell, limit):
    """Both fragilities of samples over the intensity of their motions.

    Parameters
    ----------
    shaken : Shaken
    demand : float64 array, shape (n_samples,)
        In the unit of ``limit``.
    fell : bool array, shape (n_samples,)
        Samples that do not pass whatever their demand.
    limit : float64 array, shape (n_samples,) or ()
        Demand that counts as not passing.

    Returns
    -------
    result : xarray.Dataset
        By ``fit`` the statistics of `cloud_of_case`.
    cloud : Cloud
        The regression.
    """
    intensity, weight = shaken.intensity, shaken.weight
    failed = fell | (demand > limit)
    differ = len(np.unique(intensity)) > 1  # else there is no curve
    fine = np.geomspace(intensity.min(), intensity.max(), POINTS) if differ else np.arange(1.0, POINTS + 1.0)
    cloud, likely = fit_cloud(intensity, demand, fell, limit, weight)
    bounds = np.where(failed, 0.0, intensity), np.where(failed, intensity, np.inf)
    fits = {
        "regression": (cloud, likely, _tails),
        "counts": estimate_capacity(*(bounds if differ else ([], [])), weight),
    }
    result = xr.Dataset(coords={"fit": list(fits), "bound": list(BOUNDS), "fine_intensity": fine})
    for name, of in ESTIMATES.items():
        dims = ("fine_intensity",) if name == "curve" else ()
        values = [np.asarray(of(fitted, fine), dtype=float) for fitted, *_ in fits.values()]
        limits = [limits_over(of(around, fine[:, None])) for _, around, limits_over in fits.values()]
        result[name] = ("fit", *dims), np.stack(values)
        result[f"{name}_interval"] = ("fit", "bound", *dims), np.stack(limits)
    return result, cloud


def _tails(values):
    """Limits of drawn values along the last axis."""
    tail = 0.5 - 0.5 * CONFIDENCE
    return np.quantile(values, (tail, 1.0 - tail), axis=-1, method="closest_observation")
