"""Sensitivity: which random variable makes the samples of an ensemble differ, block by block."""

import numpy as np
import scipy
import xarray as xr

from blockshake.dynamics.system import Status
from blockshake.files import content_digest
from blockshake.geometry.structure import load_structure
from blockshake.statistics.intervals import CONFIDENCE
from blockshake.statistics.resampling import DRAWS, bootstrap_interval, chance_level
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
from blockshake.study.sampling.sample_parameters import used_columns
from blockshake.study.sampling.sample_table import load_design
from blockshake.study.sensitivity.measures import (
    FEWEST_SAMPLES,
    first_order_share,
    partial_rank_correlation,
)

QUANTITIES = ("history", "peak")
_KEPT = 1.0 - 1e-9  # of a history's variance, by the components that stand for it
_MEASURES = {
    "first_order": first_order_share,
    "rank_correlation": lambda *pair: partial_rank_correlation(*pair)[0],
}
_DESCRIBED = {
    "first_order": ("first-order Sobol index, correlation ratio over classes of ranks", "1"),
    "rank_correlation": ("partial rank correlation", "1"),
    "spread": ("standard deviation over the samples", "m"),
    "explained": ("adjusted R^2 of a regression of ranks on all variables", "1"),
    "used": ("samples used", "1"),
    "correlation": ("rank correlation of two variables among the completed samples", "1"),
    "control": ("1 where model or structure has no use for the variable", "1"),
}  # fmt: skip
_NAMED = {  # without a unit
    "marker": "marker, relative to the slab's marker",
    "parameter": "dotted name of the random variable",
    "other": "dotted name of a second random variable",
    "bound": "edge of the interval",
}


def sensitivity_of_case(batches, design, model, structure, linked, levels):
    """`sensitivity` of a case's samples to all variables of a design, with those that cannot matter as controls.

    ``batches``: files of the samples; ``design``: CSV table by sample; ``linked`` as in `sample_parameters`;
    ``levels`` from `levels_of`: the result is along ``level`` where there are any.
    """
    values = load_design(design)
    used = used_columns(values, load_structure(structure), linked, model)
    ensemble = join_batches(batches, POSES, ALONG_X)
    return by_level(levels, lambda of: sensitivity(of(ensemble), values, values.columns.difference(used)))


def sensitivity(ensemble, design, controls=()):
    """Sensitivity of the histories and peaks of an ensemble to its random variables.

    Parameters
    ----------
    ensemble : xarray.Dataset
        From `join_batches`.
    design : pandas.DataFrame
        Values of the sampled variables, by sample and dotted name; stiffness that follows from them is not one.
    controls : sequence of str
        Those among them that cannot matter, see `used_columns`.

    Returns
    -------
    xarray.Dataset
        ``first_order(quantity, marker, parameter)`` [1], the first-order Sobol index, and ``rank_correlation``
        [1], the partial rank correlation; of each the 95 % bootstrap interval ``_interval(bound, ...)`` and
        ``_chance(quantity)``, what the largest over all markers and variables reaches without any effect in 95
        of 100 cases; ``explained(quantity, marker)`` [1], adjusted R^2 of a regression of ranks on all
        variables; ``spread(quantity, marker)``, standard deviation over the samples [m];
        ``used(quantity)``, samples; ``correlation(parameter, other)``, of the ranks of two variables among the
        completed samples; ``control(parameter)``, 1 where a variable cannot matter. Quantities, of each marker
        relative to the slab's along x: ``history``, the displacement at all times together, and ``peak``. A history
        has no rank correlation.

    Notes
    -----
    Samples that failed are left out. One that collapsed or still falls ranks first: its peak is at least the
    largest of the completed ones. Histories rest on the completed samples.
    Variables are taken as independent; of correlated ones the index holds what they carry of each other. The share of
    a history weighs each time by the variance there: it states what the envelope's thickness over time comes from.
    """
    counted = counted_samples(ensemble)
    variables, inputs = list(design.columns), design.loc[counted["sample"].values].to_numpy()
    seed = int(
        content_digest("sensitivity", *(str(ensemble.attrs.get(key)) for key in ("model", "structure"))), 16
    )
    generator = np.random.default_rng(seed)
    parts = []
    for quantity in QUANTITIES:
        values = _outputs(counted, quantity)
        used = np.isfinite(values).all(axis=(1, 2))
        parts.append(_measured(inputs[used], values[used], quantity == "history", generator))
    result = xr.concat(parts, dim=xr.Variable("quantity", list(QUANTITIES)))
    result["control"] = ("parameter", np.array([name in controls for name in variables], dtype=np.int8))
    completed = inputs[counted["status"].values == Status.COMPLETED]
    enough = len(completed) >= FEWEST_SAMPLES
    known = np.corrcoef(scipy.stats.rankdata(completed, axis=0), rowvar=False) if enough else np.nan
    result["correlation"] = (("parameter", "other"), np.broadcast_to(known, 2 * (len(variables),)))
    return _described(
        result.assign_coords(other=variables, marker=moving_markers(ensemble), parameter=variables),
        ensemble,
        counted,
        seed,
    )


def _outputs(counted, quantity):
    """Values of one quantity, float64 (n_samples, n_markers, n_components); NaN where a sample has none.

    A sample that did not complete has no history.
    """
    completed = counted["status"].values == Status.COMPLETED
    if quantity == "history":
        histories = block_curves(counted).transpose(0, 2, 1)
        return principal_components(np.where(completed[:, None, None], histories, np.nan))
    of_blocks = counted[quantity].sel(frame="slab", marker=moving_markers(counted))
    values = of_blocks.transpose("sample", "marker").to_numpy()
    if completed.any():
        values = np.where(completed[:, None], values, np.fmax(values, values[completed].max(axis=0)))
    return values[:, :, None]


def principal_components(histories):
    """Histories in coordinates that keep the distances between samples.

    Parameters
    ----------
    histories : float64 array, shape (n_samples, n_outputs, n_times)
        [m]; samples with NaN are unknown.

    Returns
    -------
    float64 array, shape (n_samples, n_outputs, n_components)
        [m], root mean square over the times, so that the variance summed over the components is the mean over the times
        of the variance over the samples; NaN where unknown. A variance over classes then costs no more than of a few
        numbers.
    """
    known = np.isfinite(histories).all(axis=(1, 2))
    pieces = []
    for output in range(histories.shape[1] if known.any() else 0):
        curves = histories[known, output]
        scores, singular, _ = np.linalg.svd(curves - curves.mean(axis=0), full_matrices=False)
        energy = np.cumsum(singular**2)
        needed = 1 + int(np.searchsorted(energy, _KEPT * energy[-1]))
        pieces.append((scores * singular)[:, :needed] / np.sqrt(histories.shape[2]))
    most = max((piece.shape[1] for piece in pieces), default=1)
    components = np.full((len(histories), histories.shape[1], most), np.nan)
    components[known] = 0.0
    for output, piece in enumerate(pieces):
        components[known, output, : piece.shape[1]] = piece
    return components


def _measured(inputs, outputs, is_history, generator):
    """Measures, intervals and levels of one quantity."""
    n_outputs, n_inputs = outputs.shape[1], inputs.shape[1]
    by_pair = ("marker", "parameter")
    result = {"used": ((), len(inputs)), "explained": ("marker", np.full(n_outputs, np.nan))}
    enough = len(inputs) >= FEWEST_SAMPLES
    spread = np.sqrt((outputs.var(axis=0)).sum(axis=1)) if enough else np.full(n_outputs, np.nan)
    result["spread"] = ("marker", spread)
    if enough and not is_history:
        result["explained"] = ("marker", partial_rank_correlation(inputs, outputs)[1])
    for name, measure in _MEASURES.items():
        estimate = np.full((n_outputs, n_inputs), np.nan)
        interval, level = np.stack([estimate, estimate]), np.nan
        if enough and not (is_history and name == "rank_correlation"):
            estimate = measure(inputs, outputs)
        if np.isfinite(estimate).any():
            interval = bootstrap_interval(measure, [inputs, outputs], generator)
            level = chance_level(measure, inputs, outputs, generator)
        result[name] = (by_pair, estimate)
        result[f"{name}_interval"] = (("bound", *by_pair), np.clip(interval, -1.0, 1.0))
        result[f"{name}_chance"] = ((), level)
    return xr.Dataset(result, coords={"bound": ["lower", "upper"]})


def _described(result, ensemble, counted, seed):
    describe(result, _DESCRIBED)
    for name in _MEASURES:
        of = result[name].attrs
        result[f"{name}_interval"].attrs["confidence"] = CONFIDENCE
        result[f"{name}_chance"].attrs = {
            "long_name": f"what the largest absolute {of['long_name']} reaches without any effect", "units": "1",
            "confidence": CONFIDENCE,
        }  # fmt: skip
        of["ancillary_variables"] = f"{name}_interval {name}_chance"
    for name, long_name in _NAMED.items():
        result[name].attrs = {"long_name": long_name}
    result.attrs = {
        **ensemble.attrs,
        "title": "sensitivity of an ensemble of simulated runs to its random variables",
        "counted": counted.sizes["sample"],
        "sensitivity_seed": f"{seed:x}",
        "draws": DRAWS,
    }
    return result
