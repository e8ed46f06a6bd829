"""Libraries of made-up readings: what is kept of which draw."""

from types import SimpleNamespace

import numpy as np
import xarray as xr

from blockshake.diagnosis.libraries import library as libraries
from blockshake.diagnosis.libraries.designed_test import KeptReading


def _kept_reading(planned, draw, effects, store, source, histories):
    """A reading of one feature, the number of the draw, with histories of that number where they are asked for."""
    reading = xr.Dataset({"value": ("feature", [float(draw)]), "status": "completed"}, {"feature": ["peak"]})
    if histories:
        moved = {name: ("time", np.full(4, float(draw))) for name in ("slip", "rotation", "opening", "drift")}
        reading = reading.assign(moved | {"law_value": ("law", [float(draw)])})
    return KeptReading(reading, "kept")


def test_the_first_nominal_draws_alone_keep_their_histories(monkeypatch):
    monkeypatch.setattr(libraries, "MOST_HISTORIES", 3)
    monkeypatch.setattr(libraries, "kept_reading", _kept_reading)
    monkeypatch.setattr(libraries, "draw_nominal", lambda structure, model, number: number)
    cause = SimpleNamespace(key="cause", values=lambda number: ({}, 0.5), as_effect=lambda values: {})
    planned = SimpleNamespace(structure=None, motion=SimpleNamespace(name="shake"))
    found = libraries.library(planned, "nscd-rigid", [cause], 5, 2, "store", "source", lambda line: None)
    np.testing.assert_array_equal(found.features["value"].sel(feature="peak"), [0, 1, 2, 3, 4, 0, 1])
    assert found.features["candidate"].values.tolist() == ["nominal"] * 5 + ["cause"] * 2
    np.testing.assert_array_equal(found.histories["draw"], [0, 1, 2])
    np.testing.assert_array_equal(found.histories["slip"].isel(time=0), [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(found.histories["law_value"].sel(law=0), [0.0, 1.0, 2.0])
