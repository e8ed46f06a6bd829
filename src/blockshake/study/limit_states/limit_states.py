"""Probabilities of a user's limit states, and their fragilities over the intensity of the motions."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import FALLEN, FINISHED
from blockshake.statistics.intervals import CONFIDENCE, share_interval
from blockshake.study.ensembles.case_input import structure_of_case
from blockshake.study.ensembles.ensemble import describe, join_batches, sample_figures
from blockshake.study.ensembles.envelope import BOUNDS
from blockshake.study.fragility.cloud import fragilities, shaken_by
from blockshake.study.limit_states.measures import SeenRun, value_of
from blockshake.study.limit_states.settings import MEASURES, LimitState, has_limit
from blockshake.study.sampling.sample_parameters import structure_parameters

PASSED, EXCEEDED, UNKNOWN = 0, 1, -1
_DESCRIBED = {
    "value": ("measure of the limit state, in unit", ""),
    "exceeded": ("1 beyond the limit, 0 not, -1 where the run ended before it was known", "1"),
    "probability": ("share of the samples beyond the limit", "1"),
}


def limit_states_of_case(batches, case, base, linked, limits, seed):
    """Values, probabilities and fragilities of the limit states of a case by a model.

    Parameters
    ----------
    batches : list of path
        Files of the samples.
    case : dict
        Entries of the case in the configuration.
    base : path or None
        From `measured_input`, of a case that is compared with a test.
    linked : dict of str to str
        As in `sample_parameters`.
    limits : dict of str to dict
        `LimitState` by name.
    seed : int
        The design.

    Returns
    -------
    xarray.Dataset
        By ``limit``: ``value(sample, limit)`` of its measure in SI, coordinates ``unit``, ``measure`` and
        ``limit_value``; ``exceeded(sample, limit)``; ``probability(limit)`` with ``_interval(bound, limit)``. Of
        a case with intensities: ``level_probability(level, limit)`` with its interval, where there are levels, and
        over the intensity ``median``, ``safe``, ``dispersion`` and ``curve``, as of `cloud_of_case`.

    Notes
    -----
    A sample whose run ended before its window, by a collapse or for a numerical reason, and had not exceeded the limit
    until then, is not known: the limits of a probability hold either outcome, and it is left out of the share. The
    residual of a sample that collapsed counts as beyond the limit. In a fragility, samples that are not known are left
    out.
    """
    structure = structure_of_case(case, base)
    states = {name: LimitState(**one) for name, one in limits.items()}
    states = {name: one for name, one in states.items() if has_limit(one, case["name"], structure)}
    figures, values = [], []
    for batch in batches:
        part = join_batches([batch], ("marker_displacement",))
        figures.append(sample_figures(part))
        rows = part["parameter_value"].to_pandas()
        for sample, row in rows.iterrows():
            laid = structure.with_parameters(structure_parameters(row, structure, linked))
            run = SeenRun.of(part.sel(sample=sample), laid)
            values.append([value_of(run, state) for state in states.values()])
    samples = xr.concat(
        figures, dim="sample", data_vars="minimal", coords="minimal", compat="override", join="override"
    )
    values = np.reshape(values, (samples.sizes["sample"], len(states)))
    exceeded = _exceeded(values, samples["status"].values, list(states.values()))
    result = xr.Dataset(
        {"value": (("sample", "limit"), values), "exceeded": (("sample", "limit"), exceeded.astype(np.int8))},
        {
            "sample": samples["sample"],
            "limit": list(states),
            "bound": list(BOUNDS),
            "limit_value": ("limit", [one.limit for one in states.values()]),
            "measure": ("limit", [one.measure for one in states.values()]),
            "unit": ("limit", [MEASURES[one.measure].unit for one in states.values()]),
        },
    )
    shares = np.array([_share(column) for column in exceeded.T]).reshape(-1, 3)
    result["probability"] = "limit", shares[:, 0]
    result["probability_interval"] = ("bound", "limit"), shares[:, 1:].T
    describe(result, _DESCRIBED)
    result.attrs = {"title": "limit states of a study", "confidence": CONFIDENCE}
    if not case.get("intensity"):
        return result
    over = _over_intensity(samples, case, seed, result)
    return result.merge(over).assign_attrs(result.attrs | over.attrs)


def _exceeded(values, status, states):
    """Outcome of every sample and limit state, (n_samples, n_states)."""
    beyond = values > np.array([state.limit for state in states])
    unknown = np.isnan(values) | ~np.isin(status, ("completed", "falling"))[:, None]
    found = np.where(beyond, EXCEEDED, np.where(unknown, UNKNOWN, PASSED))
    residual = np.array([state.measure == "residual" for state in states])
    found[np.ix_(np.isin(status, FALLEN), residual)] = EXCEEDED
    # a run that ended for a numerical reason is not trusted either way
    found[~np.isin(status, FINISHED)] = UNKNOWN
    return found


def _share(outcomes):
    """Share beyond the limit of the samples that are known, and its limits."""
    count, known = int((outcomes == EXCEEDED).sum()), int((outcomes != UNKNOWN).sum())
    share = count / known if known else np.nan
    return share, *share_interval(count, known, len(outcomes) - known)


def _over_intensity(samples, case, seed, result):
    """Fragilities of the limit states over the intensity, and their probabilities at each level."""
    shaken, parts = shaken_by(samples, case, seed), []
    for name in result["limit"].values:
        one = result.sel(limit=name)
        outcome, value = one["exceeded"].to_numpy(), one["value"].to_numpy()
        known = outcome != UNKNOWN
        kept = shaken._replace(
            records=[record for record, there in zip(shaken.records, known, strict=True) if there],
            intensity=shaken.intensity[known],
        )
        fell = (outcome == EXCEEDED)[known] & ~(value[known] > float(one["limit_value"]))
        part, _ = fragilities(kept, np.nan_to_num(value[known]), fell, float(one["limit_value"]))
        parts.append(part.rename(fine_intensity="point").drop_vars("point").assign(
            curve_intensity=("point", part["fine_intensity"].to_numpy())))  # fmt: skip
    over = xr.concat(parts, dim=result["limit"]) if parts else xr.Dataset()
    over = over.assign_coords(
        intensity=("sample", shaken.intensity), record=("sample", [one.name for one in shaken.records])
    )
    levels = np.unique(shaken.intensity) if shaken.target.levels else np.empty(0)
    if len(levels) == len(shaken.target.levels) and len(levels):
        outcomes = [result["exceeded"].to_numpy()[shaken.intensity == level] for level in levels]
        shares = np.array([[_share(column) for column in at.T] for at in outcomes]).reshape(
            len(levels), -1, 3
        )
        over = over.assign_coords(level=levels)
        over["level_probability"] = ("level", "limit"), shares[..., 0]
        over["level_probability_interval"] = ("bound", "level", "limit"), np.moveaxis(shares[..., 1:], 2, 0)
    over.attrs = {"intensity_measure": shaken.target.measure, "period": shaken.target.period or 0.0}
    return over
