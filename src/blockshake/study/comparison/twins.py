"""Twins of a sample: the same run a little stronger, and at half the time step; and one block that rocks alone."""

import xarray as xr

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import model_of, split_parameters
from blockshake.store import load_made
from blockshake.study.comparison.kicked_block import housner_ratio, rocking_block
from blockshake.study.ensembles.batch import simulate_samples
from blockshake.study.ensembles.ensemble import describe

TWINS = ("nudged", "half-step")
NUDGE = 1e-6  # share by which the ground motion of a twin is larger


def simulate_twins(runs, motions, row, store):
    """Twins of one sample of a case by a model, and what an impact of one of its blocks keeps.

    Parameters
    ----------
    runs, motions, store
        As of `simulate_samples`.
    row : pandas.DataFrame
        One row: the sample.

    Returns
    -------
    xarray.Dataset
        ``marker_displacement(twin, time, marker, axis)`` [m], inertial frame; ``twin`` is ``nudged``, a ground motion
        larger by one part in a million, or ``half-step``, half the time step. ``impact_ratio(step)`` [1], angular
        velocity after the first impact over that before of the structure's lowest block, which rocks on the slab
        alone after a kick, at the time step and at half of it, nominal parameters; ``housner_ratio`` [1] for it.
    """
    model, settings = runs.model, runs.settings
    half = settings | {"time_step": 0.5 * settings["time_step"]}
    twins = []
    for moved, taken in ((lambda sample: motions(sample).scaled(1.0 + NUDGE), settings), (motions, half)):
        (path,) = simulate_samples(runs._replace(settings=taken), moved, row, store)
        twins.append(load_made(path)[["marker_displacement"]].isel(sample=0, drop=True))
    structure, solver = load_structure(runs.case["structure"]), model_of(model)
    given = solver.stiffness_of(structure) | settings.get("parameters", {})
    numerical = split_parameters(given, model)[1]
    ratios = [
        rocking_block(structure, model, numerical, one["time_step"], 1.0)["impact_ratio"]
        for one in (settings, half)
    ]
    result = xr.concat(twins, dim="twin", coords="minimal", compat="override", join="override").assign_coords(
        twin=list(TWINS), step=["usual", "half"]
    )
    result["impact_ratio"] = ("step", ratios)
    result["housner_ratio"] = ((), housner_ratio(structure))
    describe(
        result,
        {
            "marker_displacement": ("marker displacement since the start", "m"),
            "impact_ratio": ("angular velocity after the first impact over that before", "1"),
            "housner_ratio": ("the same of a rigid block on two edges (Housner 1963)", "1"),
        },
    )
    result.attrs = {
        "title": "twins of a sample, and the impact of one block",
        "model": model,
        "structure": structure.file.name,
        "sample": int(row.index[0]),
        "nudge": NUDGE,
    }
    return result
