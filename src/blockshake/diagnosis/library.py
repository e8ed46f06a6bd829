"""Libraries of simulated tests, nominal or with an effect, as features: they depend on structure and motion alone."""

from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.diagnosis.features import features
from blockshake.diagnosis.joint_histories import joint_histories
from blockshake.diagnosis.null_model import draw_nominal
from blockshake.diagnosis.predicted_test import predict_test
from blockshake.diagnosis.reconstructed_base import reconstruct_base
from blockshake.files import content_digest, write_dataset
from blockshake.geometry.structure import load_structure


def library(structure, motion, duration, sensors, model, candidate, count, store, source, progress):
    """Features of simulated tests of one motion by one model, with one candidate or none.

    Parameters
    ----------
    structure : str or path
    motion : GroundMotion
        Commanded, scaled.
    duration : float
        [s]
    sensors : Sensors
    model : str
    candidate : Candidate or None
        None for the nominal model.
    count : int
        Draws: draw k of a candidate is draw k of the nominal model with the effect in it, so that their difference is
        the effect's alone.
    store : str or path
        Folder of finished tests; one that is there is not simulated again.
    source : str
        Digest of the sources that compute.
    progress : callable
        Called with a line of text after each test.

    Returns
    -------
    xarray.Dataset
        ``value(draw, feature)``, as of `features`; ``size(draw)``, the effect's in units of the visible one
        [1], 0 of the nominal model; ``status(draw)``.
    """
    built = load_structure(structure)
    parts = []
    for number in range(count):
        draw = draw_nominal(structure, model, number)
        values, size = candidate.values(number) if candidate else ({}, 0.0)
        effect = {"name": candidate.effect, "values": values, "place": candidate.place} if candidate else None
        key = content_digest(
            source, built.file.model_dump(mode="json"), *(part.tobytes() for part in motion.table), duration,
            sensors.model_dump(), draw.model, draw.time_step, draw.parameters, draw.amplitude,
            draw.places.tobytes(), draw.seed, effect,
            *(solid.vertices.tobytes() for solid in built.solids.values()),
        )  # fmt: skip
        path = Path(store) / f"{key}.nc"
        how = "kept"
        if not path.exists():
            test, status = predict_test(structure, motion, duration, draw, sensors, effect)
            how = "simulated"
            write_dataset(path, _as_features(test, built, sensors).assign(status=status, size=size))
        part = xr.load_dataset(path)
        name = candidate.key if candidate else "nominal"
        progress(f"{motion.name} {model} {name} {number}, {how}: {part['status'].item()}")
        parts.append(part)
    return xr.concat(parts, dim="draw", coords="minimal", compat="override", join="exact").assign_coords(
        draw=np.arange(count)
    )


def _as_features(test, structure, sensors):
    """Features of a simulated test by the way of a measured one; a test that ended early is judged until then."""
    known = test["marker_displacement"].notnull().all(("marker", "axis")).to_numpy()
    end = int(np.argmin(known)) if not known.all() else len(known)
    last = test["time"].to_numpy()[end - 1]
    whole = test.isel(time=slice(end))
    if "time_acc" in whole.dims:
        whole = whole.isel(time_acc=whole["time_acc"].to_numpy() <= last)
    return features(joint_histories(whole, structure, sensors, reconstruct_base(whole, structure, sensors)))
