"""Designs that grow: the size that a study has reached, and whether its accuracy suffices."""

from pathlib import Path

import numpy as np

from blockshake.files import load_json, write_json
from blockshake.statistics.intervals import quantile_interval, share_interval
from blockshake.store import load_made
from blockshake.study.analyses import ANALYSES
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.outcomes import count_outcomes

FILE = "growth.json"


def reached(config, results):
    """The `StudyConfig` of the size that a growing study has reached by the folder of all results."""
    if config.ensemble.until is None:
        return config
    size = min(_state(config, results)["size"], config.ensemble.size)
    return config.model_copy(update={"ensemble": config.ensemble.model_copy(update={"size": size})})


def grow(config, results):
    """Decide whether a study with the results of its size needs more samples, and record it, whole or not at all.

    Parameters
    ----------
    config : StudyConfig
        With the largest size.
    results : str or path
        Folder of all results; `FILE` in that of the study records size, ``stopped`` and the accuracy at every size.

    Returns
    -------
    words : str
        Why it stops, or how far it is.
    stopped : bool
    """
    state, ensemble = _state(config, results), config.ensemble
    size, found = min(state["size"], ensemble.size), accuracy(config, results)
    limits = {name: one for name, one in ensemble.until.model_dump().items() if one is not None}
    open_ones = [name for name, limit in limits.items() if not found[name] <= limit]
    each = "; ".join(
        f"{name.replace('_', ' ')} within {found[name]:.3g}, requested {limit:g}"
        for name, limit in limits.items()
    )
    known = {name: one if np.isfinite(one) else None for name, one in found.items()}
    history = [*(one for one in state["history"] if one["size"] < size), {"size": size, **known}]
    stopped = not open_ones or size == ensemble.size
    if stopped:
        words = f"stopped at {size} samples, {'as accurate as set' if not open_ones else 'the largest size'}: {each}"
    else:
        words = f"{size} samples are not enough: {each}"
    new = {
        "key": _key(config),
        "size": size if stopped else size + ensemble.batch,
        "stopped": words if stopped else "",
    }
    write_json(Path(results, config.name, FILE), new | {"history": history})
    return words, stopped


def accuracy(config, results):
    """Largest half width of the 95 % limits over cases and models, by the names of `Until`; infinite where not known.

    From the files of the samples and of the limit states, which are of one size.
    """
    study = config.model_dump(mode="json")
    files = {one.name: one.files(study).values() for one in ANALYSES if one.name in ("samples", "limits")}
    collapse, drift, limits = [0.0], [0.0], [0.0]
    for file in files["samples"]:
        samples = load_made(Path(results, config.name, file))
        ended = count_outcomes(samples["status"])
        collapse.append(_half(share_interval(ended.collapsed + ended.falling, ended.counted, ended.failed)))
        peaks = counted_samples(samples)["peak"].sel(frame="slab", drop=True).max("marker").to_numpy()
        around = quantile_interval(peaks[:, None], np.array([0.5]))
        middle = float(np.median(peaks)) if len(peaks) else 0.0
        width = _half(np.ravel(around))
        drift.append(width / middle if middle > 0.0 else (0.0 if width == 0.0 else np.inf))
    for file in files["limits"]:
        limits += [
            _half(one)
            for one in load_made(Path(results, config.name, file))["probability_interval"]
            .transpose("limit", "bound")
            .values
        ]
    widths = {"collapse_probability": collapse, "limit_states": limits, "median_drift": drift}
    return {name: float(np.max(np.nan_to_num(one, nan=np.inf))) for name, one in widths.items()}


def _half(limits):
    return 0.5 * float(limits[1] - limits[0])


def _key(config):
    """Entries that the earlier samples depend on."""
    return {"seed": config.ensemble.seed, "batch": config.ensemble.batch}


def _state(config, results):
    path = Path(results, config.name, FILE)
    state = load_json(path) if path.is_file() else {}
    if state.get("key") != _key(config):
        return {"size": config.ensemble.batch, "history": []}
    return state
