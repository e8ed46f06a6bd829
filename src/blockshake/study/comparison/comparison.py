"""The models of one case held against each other, block by block, beside the floor of the numerics of each."""

from itertools import combinations

import numpy as np
import xarray as xr

from blockshake.files import content_digest
from blockshake.measurement.motion.compared_curves import curves_along_x
from blockshake.measurement.sensors import markers
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.statistics.resampling import (
    bootstrap_interval,
    chance_distance,
    limits_of,
    resampled_weights,
)
from blockshake.statistics.scores import (
    FEWEST,
    ensemble_distance,
    ensemble_score,
    mean_differences,
    mean_width,
)
from blockshake.store import load_made
from blockshake.study.comparison.twins import TWINS
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.ensemble import ALONG_X, POSES, describe, join_batches, relative_to_slab
from blockshake.study.ensembles.envelope import counted_samples

MOST = 400  # samples of a model that are compared: each is held against each
TOLD_APART_BY = 3.0  # standard deviations of a marker's noise that curves are apart when they have parted
_MIDDLE = [0.5]
_ENDS = (0.05, 0.95)  # quantiles between which a range lies
_DESCRIBED = {
    "counted": ("samples that enter statistics", "1"),
    "peak": ("median of the largest displacement along x relative to the slab", "m"),
    "residual": ("median of the displacement along x relative to the slab at the end", "m"),
    "residual_range": ("from the 5 % to the 95 % quantile of the residual", "m"),
    "width": ("mean absolute difference of two samples relative to the slab", "m"),
    "distance": ("energy distance of the ensembles, mean over times and blocks", "m"),
    "distance_chance": ("distance that random divisions of the samples stay below", "m"),
    "history_difference": ("mean difference of the same sample by both models, median over the samples", "m"),
    "parting_time": ("first time that the same sample by both models differs, median over the samples", "s"),
    "common": ("samples that both models ran", "1"),
    "floor": ("mean difference of a sample from its twin", "m"),
    "horizon": ("first time that a sample differs from its twin", "s"),
    "impact_ratio": ("angular velocity after an impact over that before, one block alone", "1"),
    "housner_ratio": ("the same of a rigid block on two edges", "1"),
    "score": ("continuous ranked probability score against the measured curves", "m"),
    "score_difference": ("score of the other model minus that of the model", "m"),
}


def compare_case(batches, twins, named, base):
    """`compare_models` of a case, from files.

    ``batches``: files of its samples by model, of which the first `MOST` are compared; ``twins``: file from
    `simulate_twins` by model, or None; ``named`` and ``base`` as of `coverage_of_case`, None where the case is
    compared with no test.
    """
    ensembles = {model: _first_samples(files) for model, files in batches.items()}
    loaded = {model: load_made(path) for model, path in twins.items() if path}
    return compare_models(ensembles, loaded, measured_on_clock(named, base) if named else None)


def _first_samples(files):
    """Ensemble of the first samples in files that follow each other, `MOST` at most."""
    parts, count = [], 0
    for file in files:
        part = load_made(file, POSES, ALONG_X).isel(sample=slice(MOST - count))
        parts.append(part)
        count += part.sizes["sample"]
        if count == MOST:
            break
    return join_batches(parts)


def compare_models(ensembles, twins, measured):
    """Hold the models of one case against each other.

    Parameters
    ----------
    ensembles : dict of str to xarray.Dataset
        By model, from `join_batches`.
    twins : dict of str to xarray.Dataset
        By model, from `simulate_twins`, of a sample that is among those of the model; any model may be missing.
    measured : tuple of (xarray.Dataset, float) or None
        Readings on the models' clock and the markers' noise, from `measured_on_clock`.

    Returns
    -------
    xarray.Dataset
        Displacements are along x relative to the slab's marker [m]; markers are those of the blocks. Of one model:
        ``counted(model)``; medians ``peak`` and ``residual(model, marker)``; ``residual_range(model, marker)``, from
        its 5 % to its 95 % quantile; and ``width(model, marker)``, the mean absolute difference of two samples. Of two
        models, ``other`` the second: ``distance``, the energy distance of the ensembles, with ``distance_chance``;
        ``history_difference`` and ``parting_time`` of the ``common`` samples. Of the numerics, NaN without twins:
        ``floor`` and ``horizon(model, twin)``; ``impact_ratio(model, step)`` and ``housner_ratio``. Against the
        measured curves, NaN without any: ``score(model)`` and ``score_difference(model, other)``. Limits of 95 %,
        ``NAME_interval(bound, ...)``: of medians by order statistics, of range, width and scores by bootstrap. NaN
        where an ensemble has fewer than three samples, of a range six; times infinite where nothing parts.
    """
    models = list(ensembles)
    counted = {model: counted_samples(one) for model, one in ensembles.items()}
    noise = markers.NOISE if measured is None else measured[1]
    seed = int(content_digest("comparison", *_identity(ensembles)), 16)
    result = xr.merge(
        [
            _alone(counted, seed),
            _pairs(counted, TOLD_APART_BY * noise, seed),
            _numerics(counted, twins, TOLD_APART_BY * noise),
            _scores(counted, None if measured is None else measured[0], seed),
        ],
        compat="equals",
    )
    result = result.assign_coords(model=models, other=models)
    describe(result, _DESCRIBED)
    for name in result:
        if str(name).endswith("_interval"):
            of = result[str(name).removesuffix("_interval")].attrs
            result[name].attrs = {"long_name": f"limits of the {of['long_name']}", "units": of["units"]}
    first = next(iter(ensembles.values())).attrs
    result.attrs = {
        "title": "models of one case held against each other",
        "structure": str(first.get("structure")),
        "synthetic": int(measured[0].attrs.get("synthetic", 0)) if measured else 0,
        "parted_beyond": TOLD_APART_BY * noise,
    }
    return result


def _identity(ensembles):
    first = next(iter(ensembles.values())).attrs
    return (*ensembles, str(first.get("structure")), str(first.get("motion")))


def _generator(seed, *names):
    """Random numbers of one statistic, whatever else is computed."""
    return np.random.default_rng([seed, *(int(content_digest(name), 16) for name in names)])


def _blocks(ensemble):
    """Markers of the blocks, without that of the slab."""
    slab = ensemble.attrs["slab_marker"]
    return [str(name) for name in ensemble["marker"].values if name != slab]


def _curves(displacement, slab, blocks):
    """Displacement along x relative to the slab, float64 (..., n_times, n_markers) [m]."""
    along = relative_to_slab(displacement.sel(axis="x", drop=True), slab).sel(marker=blocks)
    return along.transpose(..., "time", "marker").to_numpy()


def _of(ensemble):
    return _curves(ensemble["marker_displacement"], ensemble.attrs["slab_marker"], _blocks(ensemble))


def _alone(counted, seed):
    """Numbers of each model by itself."""
    parts = []
    for model, ensemble in counted.items():
        blocks, size = _blocks(ensemble), ensemble.sizes["sample"]
        one = {"counted": ((), size)}
        for name in ("peak", "residual"):
            values = ensemble[name].sel(frame="slab", marker=blocks).transpose("sample", "marker").to_numpy()
            one[name] = ("marker", sample_quantiles(values, _MIDDLE)[0])
            one[f"{name}_interval"] = (("bound", "marker"), quantile_interval(values, _MIDDLE)[:, 0])
        one |= _residual_range(values, _generator(seed, "residual", model))
        width = np.full((1, len(blocks)), np.nan)
        if size >= FEWEST:
            curves = _of(ensemble)
            weights = resampled_weights(size, _generator(seed, model))
            width = mean_width(mean_differences(curves, curves), weights)
        one["width"] = ("marker", width[0])
        limits = limits_of(width[1:]) if size >= SURE_FROM else np.full((2, len(blocks)), np.nan)
        one["width_interval"] = (("bound", "marker"), limits)
        parts.append(xr.Dataset(one, {"marker": blocks, "bound": ["lower", "upper"]}))
    return xr.concat(parts, dim=xr.Variable("model", list(counted)))


def _residual_range(values, generator):
    """Range of the residuals (n_samples, n_markers) of the samples that have one, with its limits."""
    values = values[np.isfinite(values).all(axis=1)]
    found, limits = np.full(values.shape[1], np.nan), np.full((2, values.shape[1]), np.nan)
    if len(values) >= SURE_FROM:
        found, limits = _range(values), bootstrap_interval(_range, [values], generator)
    return {"residual_range": ("marker", found), "residual_range_interval": (("bound", "marker"), limits)}


def _range(values):
    return np.diff(sample_quantiles(values, _ENDS), axis=0)[0]


def _pairs(counted, limit, seed):
    """Distances between the models, of the ensembles and of the runs of the same samples."""
    models = list(counted)
    shape = (len(models), len(models))
    names = ("distance", "distance_chance", "history_difference", "parting_time")
    found = {name: np.full(shape, np.nan) for name in names}
    interval, common = np.full((2, *shape), np.nan), np.zeros(shape, dtype=int)
    curves = {model: _of(ensemble) for model, ensemble in counted.items()}
    for own, other in combinations(models, 2):
        places = [(models.index(own), models.index(other)), (models.index(other), models.index(own))]
        both = np.concatenate([curves[own], curves[other]])
        differences = mean_differences(both, both).mean(axis=2)
        split = len(curves[own])
        groups = np.arange(split), np.arange(split, len(both))
        values = dict.fromkeys(names, np.nan)
        if min(map(len, groups)) >= FEWEST:
            values["distance"] = ensemble_distance(differences, *groups)
            values["distance_chance"] = chance_distance(differences, *groups, _generator(seed, own, other))
        shared, at_own, at_other = np.intersect1d(
            counted[own]["sample"], counted[other]["sample"], return_indices=True
        )
        of_both = differences[at_own, split + at_other]
        values["history_difference"] = sample_quantiles(of_both, _MIDDLE)[0]
        time = counted[own]["time"].to_numpy()
        parted = [
            parting_time(time, curves[own][a], curves[other][b], limit)
            for a, b in zip(at_own, at_other, strict=True)
        ]
        values["parting_time"] = _upper_median(parted)
        for place in places:
            common[place] = len(shared)
            interval[:, *place] = quantile_interval(of_both, _MIDDLE)[:, 0]
            for name in names:
                found[name][place] = values[name]
    pair = ("model", "other")
    result = xr.Dataset({name: (pair, values) for name, values in found.items()})
    result["common"] = (pair, common)
    result["history_difference_interval"] = (("bound", *pair), interval)
    return result.assign_coords(model=models, other=models, bound=["lower", "upper"])


def parting_time(time, curve, other, limit):
    """First time at which two curves differ by more than a limit at any marker [s]; infinite if they never do.

    ``curve``, ``other`` (n_times, n_markers) [m]; a run that ended before the other differs from then on.
    """
    with np.errstate(invalid="ignore"):
        beyond = np.abs(curve - other) > limit
    beyond |= np.isfinite(curve) != np.isfinite(other)
    parted = beyond.any(axis=1)
    return float(time[np.argmax(parted)]) if parted.any() else np.inf


def _upper_median(times):
    """Median of times some of which may be infinite; of two middle ones the later."""
    return sorted(times)[len(times) // 2] if times else np.nan


def _numerics(counted, twins, limit):
    """Floor and horizon of each model's numerics, and what its impacts keep."""
    models = list(counted)
    floor, horizon = np.full((2, len(models), len(TWINS)), np.nan)
    ratio, housner = np.full((len(models), 2), np.nan), np.nan
    for place, model in enumerate(models):
        if model not in twins:
            continue
        given, ensemble = twins[model], counted[model]
        ratio[place] = given["impact_ratio"].sel(step=["usual", "half"])
        housner = float(given["housner_ratio"])
        if given.attrs["sample"] not in ensemble["sample"].values:
            continue  # it failed, and has no twin
        own = _of(ensemble.sel(sample=given.attrs["sample"]))
        for number, twin in enumerate(TWINS):
            moved = given["marker_displacement"].sel(twin=twin)
            other = _curves(moved, ensemble.attrs["slab_marker"], _blocks(ensemble))
            floor[place, number] = mean_differences(own[None], other[None]).mean()
            horizon[place, number] = parting_time(ensemble["time"].to_numpy(), own, other, limit)
    return xr.Dataset(
        {
            "floor": (("model", "twin"), floor),
            "horizon": (("model", "twin"), horizon),
            "impact_ratio": (("model", "step"), ratio),
            "housner_ratio": ((), housner),
        },
        {"model": models, "twin": list(TWINS), "step": ["usual", "half"]},
    )


def _scores(counted, measured, seed):
    """Scores against the measured curves, and how they differ from model to model."""
    models = list(counted)
    drawn = {}
    for model, ensemble in counted.items():
        size = ensemble.sizes["sample"]
        if measured is None or size < FEWEST:
            continue
        read, curves = (one.to_numpy() for one in curves_along_x(measured, ensemble))
        seen = np.where(np.isfinite(read), curves, np.nan)
        weights = resampled_weights(size, _generator(seed, "score", model))
        away = mean_differences(seen, read[None])[:, 0].mean(axis=1)
        drawn[model] = ensemble_score(away, mean_differences(seen, seen).mean(axis=2), weights)
    score, interval = np.full(len(models), np.nan), np.full((2, len(models)), np.nan)
    shape = (len(models), len(models))
    difference, apart = np.full(shape, np.nan), np.full((2, *shape), np.nan)
    for place, model in enumerate(models):
        if model not in drawn:
            continue
        score[place] = drawn[model][0]
        sure = counted[model].sizes["sample"] >= SURE_FROM
        interval[:, place] = limits_of(drawn[model][1:]) if sure else np.nan
        for number, other in enumerate(models):
            if other in drawn and other != model:
                excess = drawn[other] - drawn[model]
                difference[place, number] = excess[0]
                apart[:, place, number] = limits_of(excess[1:])
    pair = ("model", "other")
    return xr.Dataset(
        {
            "score": ("model", score),
            "score_interval": (("bound", "model"), interval),
            "score_difference": (pair, difference),
            "score_difference_interval": (("bound", *pair), apart),
        },
        {"model": models, "other": models, "bound": ["lower", "upper"]},
    )
