"""Twins of a sample: the same run a little stronger, and at half the time step."""

import xarray as xr

from blockshake.geometry.structure import load_structure
from blockshake.store import load_made
from blockshake.study.ensembles.batch import simulate_samples

TWINS = ("nudged", "half-step")
NUDGE = 1e-6  # share by which the ground motion of a twin is larger


def simulate_twins(runs, motions, row, store):
    """Twins of one sample of a case by a model.

    Parameters
    ----------
    runs, motions, store
        Those of `simulate_samples`.
    row : pandas.DataFrame
        One row: the sample.

    Returns
    -------
    xarray.Dataset
        ``marker_displacement(twin, time, marker, axis)`` [m], inertial frame; ``twin`` is ``nudged``, a ground motion
        larger by one part in a million, or ``half-step``, half the time step.
    """
    half = runs.settings | {"time_step": 0.5 * runs.settings["time_step"]}
    twins = []
    for moved, settings in (
        (lambda sample: motions(sample).scaled(1.0 + NUDGE), runs.settings),
        (motions, half),
    ):
        (path,) = simulate_samples(runs._replace(settings=settings), moved, row, store)
        twins.append(load_made(path)[["marker_displacement"]].isel(sample=0, drop=True))
    result = xr.concat(twins, dim="twin", coords="minimal", compat="override", join="override")
    result = result.assign_coords(twin=list(TWINS))
    result.attrs = {
        "title": "twins of a sample",
        "model": runs.model,
        "structure": load_structure(runs.case["structure"]).file.name,
        "sample": int(row.index[0]),
        "nudge": NUDGE,
    }
    return result
