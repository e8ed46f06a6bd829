"""Libraries of simulated tests, nominal or with an effect. They depend on structure, motion and sensors alone."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.libraries.candidates import NOMINAL
from blockshake.diagnosis.libraries.designed_test import kept_reading
from blockshake.diagnosis.libraries.null_model import draw_nominal

MOST_HISTORIES = (
    500  # nominal draws of which histories are kept: a chance is then known to a fifth of a percent
)


class Library(NamedTuple):
    """Features of all runs of a library, and histories of the first nominal ones."""

    features: xr.Dataset
    histories: xr.Dataset


def library(planned, model, candidates, nominal_draws, own_draws, store, source, progress):
    """Features of simulated tests by one model: nominal, and with every candidate.

    Parameters
    ----------
    planned : PlannedTest
    model : str
        One of `null_model.MODELS`.
    candidates : sequence of Candidate
    nominal_draws, own_draws : int
        Draws of the nominal model and with each candidate: draw k of a candidate is draw k of the nominal model with
        the effect in it, so that their difference is the effect's alone.
    store : str or path
        Folder of finished tests; one that is there is not simulated again.
    source : str
        Digest of the sources that compute.
    progress : callable
        Called with a line of text after each test.

    Returns
    -------
    Library
        ``features`` along ``run``: ``value(run, feature)``; coordinates ``candidate(run)``, its key or ``nominal``;
        ``draw(run)``; ``size(run)``, the effect's in units of the visible one [1]; ``status(run)``. ``histories``:
        ``slip``, ``rotation``, ``opening`` and ``drift(draw, time, ...)`` of the first nominal runs, `MOST_HISTORIES`
        at most, as from `read_off`; NaN after a run that ended early; and ``law_value(draw, law)``.
    """
    parts, moved = [], []
    jobs = [(None, number) for number in range(nominal_draws)]
    jobs += [(candidate, number) for candidate in candidates for number in range(own_draws)]
    for done, (candidate, number) in enumerate(jobs, start=1):
        values, size = candidate.values(number) if candidate else ({}, 0.0)
        effects = [candidate.as_effect(values)] if candidate else []
        draw = draw_nominal(planned.structure, model, number)
        moves = candidate is None and number < MOST_HISTORIES
        reading, how = kept_reading(planned, draw, effects, store, source, histories=moves)
        name = candidate.key if candidate else NOMINAL
        progress(
            f"{planned.motion.name} {model} {done}/{len(jobs)} {name} {number} {how}: {reading['status'].item()}"
        )
        labels = {"candidate": name, "draw": number, "size": size, "status": reading["status"].item()}
        one = reading[["value"]].expand_dims("run")
        parts.append(one.assign_coords({label: ("run", [value]) for label, value in labels.items()}))
        if moves:
            moved.append(
                reading[["slip", "rotation", "opening", "drift", "law_value"]].reset_coords(drop=True)
            )
    whole = xr.concat(
        parts, dim="run", coords="minimal", compat="override", join="exact", data_vars="minimal"
    )
    histories = xr.concat(moved, dim="draw", join="outer").assign_coords(draw=np.arange(len(moved)))
    return Library(whole.assign_attrs(model=model), histories.assign_attrs(model=model))
