"""Change of the responses by a cause: the same samples of a case with and without it, next to a measured test."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import FALLEN
from blockshake.files import content_digest
from blockshake.statistics.intervals import sample_quantiles, share_interval
from blockshake.statistics.resampling import limits_of, resampled_weights
from blockshake.statistics.scores import FEWEST, ensemble_score, mean_width, member_scores
from blockshake.store import load_made
from blockshake.study.comparison.comparison import first_samples, score_parts
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.ensemble import describe
from blockshake.study.ensembles.envelope import counted_samples

HIGH = 0.95  # quantile that stands for a large response
QUANTITIES = ("median_drift", "drift", "uplift", "collapse", "safe_scale")
SIDES = ("without", "extended", "change")
_BEYOND = 0.95  # share of the members' own scores that a score must exceed for anything to be gained
_DESCRIBED = {
    "value": (
        "of the samples without and with the cause, and the latter less the former",
        "unit of the quantity",
    ),
    "score": ("continuous ranked probability score against the measured curves", "m"),
    "gain": ("share of the error without the cause that the cause removes", "1"),
}


def change_of_case(batches, climber, fragilities, named, base):
    """`changes` of a case, from files.

    ``batches``: by model the files of its samples without the cause, and those with it; ``fragilities``: both files of
    its fragility, by the model ``climber``, or empty; ``named`` and ``base`` as of `coverage_of_case`, None where there
    is no measured test.
    """
    ensembles = {model: [first_samples(files) for files in pair] for model, pair in batches.items()}
    result = changes(ensembles, measured_on_clock(named, base)[0] if named else None)
    return with_fragility(result, climber, *map(load_made, fragilities)) if fragilities else result


def changes(ensembles, measured):
    """Hold the samples of a case with a cause against the same samples without it.

    Parameters
    ----------
    ensembles : dict of str to pair of xarray.Dataset
        By model, from `join_batches`: without and with the cause.
    measured : xarray.Dataset or None
        Readings on the models' clock, from `measured_on_clock`.

    Returns
    -------
    xarray.Dataset
        ``value(model, quantity, side)``, ``without`` and ``extended`` by the cause, and the ``change``:
        ``median_drift`` and ``drift``, median and 95 % quantile of the largest displacement along x of any block's
        markers from the slab [m]; ``uplift``, 95 % quantile of the largest of any joint [m]; ``collapse``, share of
        the samples that fall [1];
        ``safe_scale``, of `with_fragility` [1]. ``score(model, kind)`` [m] and ``gain(model)``, 1 where nothing is left
        to gain, NaN where the samples without the cause fit within chance. Limits of 95 % of each: ``NAME_interval``.
        ``paired(model)``: samples that both have a result of.

    Notes
    -----
    Member k of both has the same values of all other variables, so that the bootstrap draws the pair. The limits of a
    share are those of Clopper and Pearson, and the change of the share is that of the samples which fall in one of both
    alone. Limits of differences of shares and of safe scales are put together from those of their parts (Zou and Donner
    2008, Stat. Med. 27), as if these were independent: safe scales of the same samples are not, which errs on the wide
    side. Gain is ``(S - S_extended) / (S - S_floor)``, the floor what the extended members score in the mean when each
    is taken for the record.
    """
    parts = []
    for model, pair in ensembles.items():
        counted = [counted_samples(one) for one in pair]
        common = np.intersect1d(*(one["sample"] for one in counted))
        both = [one.sel(sample=common) for one in counted]
        seed = int(content_digest("changes", model, str(pair[1].attrs.get("structure"))), 16)
        weights = resampled_weights(len(common), np.random.default_rng(seed)) if len(common) else None
        parts.append(
            quantities(map(_responses, both), weights)
            .merge(_gain(both, measured, weights))
            .assign(paired=len(common))
        )
    result = xr.concat(parts, dim=xr.Variable("model", list(ensembles)))
    describe(result, _DESCRIBED)
    return result.assign_attrs(title="change of the responses by a cause")


def with_fragility(result, climber, *fragilities):
    """`changes` with the safe scales of both `fragility`, without and with the cause, by the model that climbed."""
    safe = [_safe(one) for one in fragilities]
    at, rows = {"quantity": "safe_scale", "model": climber}, np.array([*safe, _difference(*safe)])
    result["value"].loc[at], result["value_interval"].loc[at] = rows[:, 0], rows[:, 1:]
    return result


def _safe(fragility):
    """Safe scale with its limits, the two levels where all capacities lie between them."""
    limits = fragility["safe_scale_interval"].to_numpy()
    if float(fragility["dispersion"]) == 0.0:
        limits = float(fragility["capacity_lower"].max()), float(fragility["capacity_upper"].min())
    return float(fragility["safe_scale"]), *limits


def quantities(sides, weights):
    """Quantities of `changes` of pairs of samples, their change and limits, NaN without samples; the safe scale apart.

    ``sides``: without and with the cause, each its largest drift and uplift [m] and whether it fell, by sample;
    ``weights``: of `resampled_weights`, None without samples.
    """
    rows = np.full((len(QUANTITIES), len(SIDES), 3), np.nan)
    if weights is not None:
        drift, uplift, fell = zip(*sides, strict=True)
        for row, (values, share) in enumerate([(drift, 0.5), (drift, HIGH), (uplift, HIGH)]):
            drawn = [_drawn_quantiles(one, weights, share) for one in values]
            rows[row] = [(one[0], *limits_of(one[1:])) for one in (*drawn, drawn[1] - drawn[0])]
        alone = [_share(fell[0] & ~fell[1]), _share(fell[1] & ~fell[0])]
        rows[3] = [*map(_share, fell), _difference(*alone)]
    dims = ("quantity", "side")
    return xr.Dataset(
        {"value": (dims, rows[..., 0]), "value_interval": ((*dims, "bound"), rows[..., 1:])},
        {"quantity": list(QUANTITIES), "side": list(SIDES), "bound": ["lower", "upper"]},
    )


def _responses(ensemble):
    """Largest drift of any block's marker from the slab and uplift of any joint [m], and who fell, by sample."""
    drift, uplift = ensemble["peak"].sel(frame="slab").max("marker"), ensemble["joint_uplift"].max("joint")
    return drift.to_numpy(), uplift.to_numpy(), np.isin(ensemble["status"].values, FALLEN)


def _drawn_quantiles(values, weights, share):
    """Quantile of values drawn as often as each row of the weights states, (n_draws,)."""
    drawn = (np.repeat(values, row.astype(int)) for row in weights)
    return np.array([sample_quantiles(one, (share,))[0] for one in drawn])


def _share(chosen):
    return float(chosen.mean()), *share_interval(int(chosen.sum()), len(chosen))


def _difference(first, second):
    """Second less first, each an estimate with its limits; the difference likewise."""
    value = second[0] - first[0]
    below = np.hypot(second[0] - second[1], first[2] - first[0])
    return value, value - below, value + np.hypot(second[2] - second[0], first[0] - first[1])


def _gain(both, measured, weights):
    """Scores against the measured curves, and the gain; NaN without these, or of few samples."""
    score, gain, limits = np.full(2, np.nan), np.nan, np.full(2, np.nan)
    if measured is not None and weights is not None and weights.shape[1] >= FEWEST:
        parts = [score_parts(one, measured) for one in both]
        drawn = [ensemble_score(*one, weights) for one in parts]
        floor, score = 0.5 * mean_width(parts[1][1], weights), np.array([one[0] for one in drawn])
        if score[0] > np.quantile(member_scores(parts[1][1]), _BEYOND):
            gains = np.clip((drawn[0] - drawn[1]) / np.maximum(drawn[0] - floor, 1e-9), -1.0, 1.0)
            gain, limits = gains[0], limits_of(gains[1:])
    kinds = {"kind": ["without", "extended"], "bound": ["lower", "upper"]}
    return xr.Dataset({"score": ("kind", score), "gain": gain, "gain_interval": ("bound", limits)}, kinds)
