"""All answers of a study in one table, for any other program: a row a run."""

from pathlib import Path

import pandas as pd

from blockshake.dynamics.record_set import DrawnMotions
from blockshake.store import load_made
from blockshake.study.sampling.sample_table import load_design

_ENDINGS = ("status", "reason", "end_time")
# responses by their name in the samples' files: along what they are reported, and the unit
_RESPONSES = {
    "peak": ("marker", "m"),
    "residual": ("marker", "m"),
    "peak_rotation": ("body", "rad"),
    "joint_uplift": ("joint", "m"),
    "joint_slip": ("joint", "m"),
    "joint_compression": ("joint", "N"),
}


def response_table(study, results):
    """Table of the runs of a finished study.

    Parameters
    ----------
    study : dict
        ``cases``, ``models``, ``limits`` and ``ensemble`` of its configuration.
    results : str or path
        Folder of its results.

    Returns
    -------
    pandas.DataFrame
        A row for each case, model and sample. Columns: ``model``, ``case``, ``sample``; ``record`` and ``level`` of
        the motion that it draws, empty without any; ``status``, ``reason``, ``end_time [s]``; the sampled values by
        their dotted names, SI; ``limit.NAME [unit]`` and ``limit.NAME.exceeded`` (1, 0, empty where not known) of
        each limit state; responses as ``peak.MARKER [m]``, relative to the slab along x. Empty where a structure has
        not what a column tells.

    Raises
    ------
    InputError
        A file of the results is missing or holds something else.
    """
    results, parts = Path(results), []
    design = load_design(results / "design.csv")
    for case in study["cases"]:
        for model in study["models"]:
            samples = load_made(results / "samples" / model / f"{case['name']}.nc")
            limits = results / "limits" / model / f"{case['name']}.nc"
            parts.append(_rows(case, model, samples, design, study["ensemble"]["seed"]))
            if study.get("limits") and limits.exists():
                parts[-1] = parts[-1].join(_limits(load_made(limits)))
    table = pd.concat(parts, ignore_index=True)
    last = [name for name in table.columns if name.partition(".")[0] in _RESPONSES]
    return table[[name for name in table.columns if name not in last] + last]


def _rows(case, model, samples, design, seed):
    index = pd.Index(samples["sample"].values, name="sample")
    columns = {
        "model": model,
        "case": case["name"],
        "sample": index.to_numpy(),
        "record": None,
        "level": None,
    }
    if case.get("intensity"):
        drawn = DrawnMotions.of(case)
        records = [drawn.draw(sample, seed) for sample in index]
        columns |= {"record": [one.name for one in records], "level": [one.level for one in records]}
    for name in _ENDINGS:
        columns[f"{name} [s]" if name == "end_time" else name] = samples[name].values
    columns |= dict(design.loc[index].items())
    columns |= {str(name): column for name, column in samples["parameter_value"].to_pandas().items()}
    for name, (along, unit) in _RESPONSES.items():
        values = (
            samples[name].sel(frame="slab", drop=True) if "frame" in samples[name].dims else samples[name]
        )
        for label in values[along].values:
            columns[f"{name}.{label} [{unit}]"] = values.sel({along: label}).values
    return pd.DataFrame(columns, index=index)


def _limits(found):
    index = pd.Index(found["sample"].values, name="sample")
    columns = {}
    for name in found["limit"].values:
        one = found.sel(limit=name)
        columns[f"limit.{name} [{one['unit'].item()}]"] = one["value"].values
        columns[f"limit.{name}.exceeded"] = pd.array(one["exceeded"].values, dtype="Int64")
        columns[f"limit.{name}.exceeded"][one["exceeded"].values < 0] = pd.NA
    return pd.DataFrame(columns, index=index)
