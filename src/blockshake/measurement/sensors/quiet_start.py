"""The quiet start of a test: readings counted from rest, and until when the table is still."""

import numpy as np

from blockshake.measurement.sensors.markers import marker_bodies

LONGEST = 0.5  # s
_STILL, _LEAST = 5.0, 5e-4  # standard deviations of a marker, m: a noise of nothing may be stated
_FIRST = 10  # readings, whose median is where a marker starts


def counted_from_rest(test, structure, sensors):
    """Readings counted from their means while the table was still, and the time until which it was [s]."""
    time = test["time"].to_numpy()
    driven = {body.name for body in structure.file.bodies if body.driven}
    table = [body in driven for body in marker_bodies(structure, test["marker"].values)]
    moved = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()[:, table, 0]
    moved = moved[:, np.isfinite(moved[:_FIRST]).any(axis=0)]
    away = np.abs(moved - np.nanmedian(moved[:_FIRST], axis=0)) > max(_STILL * sensors.marker_noise, _LEAST)
    moving = away.all(axis=1) & (moved.shape[1] > 0)
    end = time[np.argmax(moving)] if moving.any() else time[-1]
    until = float(min(end, time[0] + LONGEST))
    rest = test["marker_displacement"].isel(time=time <= until).mean("time").fillna(0.0)
    counted = {"marker_displacement": test["marker_displacement"] - rest}
    if "accelerometer" in test:
        before = test["time_acc"].to_numpy() <= until
        counted["accelerometer"] = test["accelerometer"] - test["accelerometer"].isel(time_acc=before).mean(
            "time_acc"
        )
    return test.assign(counted), until
