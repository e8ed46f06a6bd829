"""The models of one case held against each other, block by block, against the floor of the numerics of each."""

from itertools import combinations

import numpy as np
import xarray as xr

from blockshake.files import content_digest
from blockshake.measurement.motion.compared_curves import curves_along_x
from blockshake.measurement.sensors import markers
from blockshake.simulation.models import solver_of
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.statistics.resampling import chance_distance, limits_of, resampled_weights
from blockshake.statistics.scores import (
    FEWEST,
    ensemble_distance,
    ensemble_score,
    mean_differences,
    mean_width,
)
from blockshake.store import load_made
from blockshake.study.comparison.two_levels import two_levels
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.ensemble import (
    ALONG_X,
    POSES,
    block_curves,
    describe,
    join_batches,
    moving_markers,
)
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.levels import by_level

MOST = 400  # samples of a model that are compared: each is held against each
PARTED_BY = 3.0  # standard deviations of a marker's noise that curves are apart when they have parted
CHANGES = (
    "peak",
    "residual",
    "width",
)  # of a solver with other settings, distinguished from the same samples
_MIDDLE = [0.5]
_DESCRIBED = {
    "counted": ("samples that enter statistics", "1"),
    "peak": ("median of the largest displacement along x relative to the slab", "m"),
    "residual": ("median of the displacement along x relative to the slab at the end", "m"),
    "width": ("mean absolute difference of two samples relative to the slab", "m"),
    "peak_change": ("peak minus that of the model of the solver's plain name, median of the pairs", "m"),
    "residual_change": ("residual minus that of the model of the plain name, median of the pairs", "m"),
    "width_change": ("width minus that of the model of the plain name, of the same samples", "m"),
    "changed": ("samples that both models have", "1"),
    "distance": ("energy distance of the ensembles, mean over times and blocks", "m"),
    "distance_chance": ("distance that random divisions of the samples stay below", "m"),
    "history_difference": ("mean difference of the same sample by both models, median over the samples", "m"),
    "parting_time": ("first time that the same sample by both models differs, median over the samples", "s"),
    "common": ("samples that both models ran", "1"),
    "floor": ("mean difference of a sample from its replicate of half the step", "m"),
    "horizon": ("first time that a sample differs from its replicate of half the step", "s"),
    "mean_peak": ("mean of the largest displacement of any marker along x relative to the slab", "m"),
    "two_level_peak": ("the same mean with rigid NSCD as a control variate", "m"),
    "coefficient": ("of the control variate", "1"),
    "peak_correlation": ("of that displacement by the model and by rigid NSCD", "1"),
    "variance_gain": ("variance of the mean over that with the control variate", "1"),
    "score": ("continuous ranked probability score against the measured curves", "m"),
}


def compare_case(batches, replicates, named, base, levels):
    """`compare_models` of a case, from files.

    ``batches``: files of its samples by model, of which the first `MOST` are compared; ``replicates``: file of the
    batch `HALF_STEP` by model, or None; ``named`` and ``base`` as of `coverage_of_case`, None where the case is
    compared with no test; ``levels`` from `levels_of`: the result is along ``level`` where there are any.
    """
    ensembles = {model: first_samples(files) for model, files in batches.items()}
    loaded = {model: first_samples([path]) for model, path in replicates.items() if path}
    measured = measured_on_clock(named, base) if named else None
    return by_level(
        levels,
        lambda of: compare_models(
            {model: of(one) for model, one in ensembles.items()},
            {model: of(one) for model, one in loaded.items()},
            measured,
        ),
    )


def first_samples(files):
    """Ensemble of the first samples in files that follow each other, `MOST` at most."""
    parts, count = [], 0
    for file in files:
        part = load_made(file, POSES, ALONG_X).isel(sample=slice(MOST - count))
        parts.append(part)
        count += part.sizes["sample"]
        if count == MOST:
            break
    return join_batches(parts)


def compare_models(ensembles, replicates, measured):
    """Hold the models of one case against each other.

    Parameters
    ----------
    ensembles : dict of str to xarray.Dataset
        By model, from `join_batches`.
    replicates : dict of str to xarray.Dataset
        By model, from `join_batches`: a sample of the model once more, at half the time step; any may be missing.
    measured : tuple of (xarray.Dataset, float) or None
        Readings on the models' clock and the markers' noise, from `measured_on_clock`.

    Returns
    -------
    xarray.Dataset
        Displacements are along x relative to the slab's marker [m]; markers are those of the blocks. Of one model:
        ``counted(model)``; medians ``peak`` and ``residual(model, marker)``; and ``width(model, marker)``, the mean
        absolute difference of two samples. Of a model with settings of its own, against that of its solver's name
        alone, over the ``changed(model)`` samples of both: ``peak_change``, ``residual_change`` and
        ``width_change(model, marker)``, NaN for all others. Of two
        models, ``other`` the second: ``distance``, the energy distance of the ensembles, with ``distance_chance``;
        ``history_difference`` and ``parting_time`` of the ``common`` samples. Of the numerics, NaN without replicates:
        ``floor`` and ``horizon(model)``. Against the measured curves, NaN without any: ``score(model)``. Of models
        with fewer samples than rigid NSCD those of `two_levels`. Limits of 95 %, ``NAME_interval(bound, ...)``: of
        medians by order statistics, of width and score by bootstrap. NaN where an ensemble has fewer than three
        samples; times infinite where nothing parts.
    """
    models = list(ensembles)
    counted = {model: counted_samples(one) for model, one in ensembles.items()}
    noise = markers.NOISE if measured is None else measured[1]
    first = next(iter(ensembles.values())).attrs
    structure = str(first.get("structure"))
    seed = int(content_digest("comparison", *ensembles, structure, str(first.get("motion"))), 16)
    result = xr.merge(
        [
            _alone(counted, seed),
            two_levels(ensembles),
            _changes(counted, seed),
            _pairs(counted, PARTED_BY * noise, seed),
            _numerics(counted, replicates, PARTED_BY * noise),
            _scores(counted, None if measured is None else measured[0], seed),
        ],
        compat="equals",
    )
    result = result.assign_coords(model=models, other=models)
    describe(result, _DESCRIBED)
    result.attrs = {
        "title": "models of one case held against each other",
        "structure": structure,
        "synthetic": int(measured[0].attrs.get("synthetic", 0)) if measured else 0,
        "parted_beyond": PARTED_BY * noise,
    }
    return result


def _generator(seed, *names):
    """Random numbers of one statistic, whatever else is computed."""
    return np.random.default_rng([seed, *(int(content_digest(name), 16) for name in names)])


def _alone(counted, seed):
    """Numbers of each model by itself."""
    parts = []
    for model, ensemble in counted.items():
        blocks, size = moving_markers(ensemble), ensemble.sizes["sample"]
        one = {"counted": ((), size)}
        for name in ("peak", "residual"):
            values = ensemble[name].sel(frame="slab", marker=blocks).transpose("sample", "marker").to_numpy()
            one[name] = ("marker", sample_quantiles(values, _MIDDLE)[0])
            one[f"{name}_interval"] = (("bound", "marker"), quantile_interval(values, _MIDDLE)[:, 0])
        width, width_limits = np.full(len(blocks), np.nan), np.full((2, len(blocks)), np.nan)
        if size >= FEWEST:
            curves = block_curves(ensemble)
            weights = resampled_weights(size, _generator(seed, model))
            width, *resampled = mean_width(mean_differences(curves, curves), weights)
            width_limits = limits_of(np.array(resampled)) if size >= SURE_FROM else width_limits
        one |= {"width": ("marker", width), "width_interval": (("bound", "marker"), width_limits)}
        parts.append(xr.Dataset(one, {"marker": blocks, "bound": ["lower", "upper"]}))
    return xr.concat(parts, dim=xr.Variable("model", list(counted)))


def _changes(counted, seed):
    """Changes by the settings of a model against that of its solver's plain name, over the samples of both."""
    parts = []
    for model, own in counted.items():
        other, blocks = counted.get(solver_of(model).name, own), moving_markers(own)
        both = [] if other is own else np.intersect1d(own["sample"], other["sample"])
        pair = [one.isel(sample=np.isin(one["sample"], both)) for one in (own, other)]
        one = {"changed": ((), len(both))}
        for name in ("peak", "residual"):
            values = [of[name].sel(frame="slab", marker=blocks).transpose("sample", "marker") for of in pair]
            moved = np.subtract(*(of.to_numpy() for of in values))
            one[f"{name}_change"] = ("marker", sample_quantiles(moved, _MIDDLE)[0])
            one[f"{name}_change_interval"] = (("bound", "marker"), quantile_interval(moved, _MIDDLE)[:, 0])
        drawn = np.full((1, len(blocks)), np.nan)
        if len(both) >= FEWEST:
            weights = resampled_weights(len(both), _generator(seed, "change", model))
            widths = [mean_width(mean_differences(of, of), weights) for of in map(block_curves, pair)]
            drawn = np.subtract(*widths)
        one["width_change"] = ("marker", drawn[0])
        limits = limits_of(drawn[1:] if len(both) >= SURE_FROM else drawn[:0])
        one["width_change_interval"] = (("bound", "marker"), limits)
        parts.append(xr.Dataset(one, {"marker": blocks, "bound": ["lower", "upper"]}))
    return xr.concat(parts, dim=xr.Variable("model", list(counted)))


def _pairs(counted, limit, seed):
    """Distances between the models, of the ensembles and of the runs of the same samples."""
    models = list(counted)
    shape = (len(models), len(models))
    names = ("distance", "distance_chance", "history_difference", "parting_time")
    pairs = {name: np.full(shape, np.nan) for name in names}
    interval, common = np.full((2, *shape), np.nan), np.zeros(shape, dtype=int)
    curves = {model: block_curves(ensemble) for model, ensemble in counted.items()}
    for row, column in combinations(range(len(models)), 2):
        model, other = models[row], models[column]
        both = np.concatenate([curves[model], curves[other]])
        differences = mean_differences(both, both).mean(axis=2)
        split = len(curves[model])
        groups = np.arange(split), np.arange(split, len(both))
        values = dict.fromkeys(names, np.nan)
        if min(map(len, groups)) >= FEWEST:
            values["distance"] = ensemble_distance(differences, *groups)
            values["distance_chance"] = chance_distance(differences, *groups, _generator(seed, model, other))
        shared, at_model, at_other = np.intersect1d(
            counted[model]["sample"], counted[other]["sample"], return_indices=True
        )
        of_both = differences[at_model, split + at_other]
        values["history_difference"] = sample_quantiles(of_both, _MIDDLE)[0]
        time = counted[model]["time"].to_numpy()
        parted = [
            parting_time(time, curves[model][a], curves[other][b], limit)
            for a, b in zip(at_model, at_other, strict=True)
        ]
        # some may be infinite; of two middle ones the later
        values["parting_time"] = sorted(parted)[len(parted) // 2] if parted else np.nan
        for cell in ((row, column), (column, row)):
            common[cell] = len(shared)
            interval[:, *cell] = quantile_interval(of_both, _MIDDLE)[:, 0]
            for name in names:
                pairs[name][cell] = values[name]
    dimensions = ("model", "other")
    result = xr.Dataset({name: (dimensions, values) for name, values in pairs.items()})
    result["common"] = (dimensions, common)
    result["history_difference_interval"] = (("bound", *dimensions), interval)
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


def _numerics(counted, replicates, limit):
    """Floor and horizon of each model's numerics, NaN without a replicate, or where it or its sample failed."""
    models = list(counted)
    floor, horizon = np.full((2, len(models)), np.nan)
    for row, model in enumerate(models):
        if model not in replicates:
            continue
        replicate = counted_samples(replicates[model])
        shared = np.intersect1d(replicate["sample"], counted[model]["sample"])
        if shared.size:
            sample, other = (block_curves(one.sel(sample=shared)) for one in (counted[model], replicate))
            floor[row] = mean_differences(sample, other).mean()
            horizon[row] = parting_time(replicate["time"].to_numpy(), sample[0], other[0], limit)
    return xr.Dataset({"floor": ("model", floor), "horizon": ("model", horizon)}, {"model": models})


def score_parts(ensemble, measured):
    """Mean differences [m] of samples from the measured curves, and from each other, as `ensemble_score` takes them."""
    read, curves = (one.to_numpy() for one in curves_along_x(measured, ensemble))
    seen = np.where(np.isfinite(read), curves, np.nan)
    return mean_differences(seen, read[None])[:, 0].mean(axis=1), mean_differences(seen, seen).mean(axis=2)


def _scores(counted, measured, seed):
    """Scores against the measured curves."""
    score, interval = np.full(len(counted), np.nan), np.full((2, len(counted)), np.nan)
    for row, (model, ensemble) in enumerate(counted.items()):
        size = ensemble.sizes["sample"]
        if measured is None or size < FEWEST:
            continue
        weights = resampled_weights(size, _generator(seed, "score", model))
        score[row], *resampled = ensemble_score(*score_parts(ensemble, measured), weights)
        if size >= SURE_FROM:
            interval[:, row] = limits_of(np.array(resampled))
    return xr.Dataset(
        {"score": ("model", score), "score_interval": (("bound", "model"), interval)},
        {"model": list(counted), "bound": ["lower", "upper"]},
    )
