"""Readings of the driven body's motion by its sensors."""

from typing import NamedTuple

import numpy as np

from blockshake.measurement.motion.body_poses import TRANSLATION, body_poses, driven_body


class ChannelReadings(NamedTuple):
    """Readings of one accelerometer channel, float64 (n_readings,), NaN for a gap [s, m/s2]."""

    time: np.ndarray
    values: np.ndarray


def base_coordinates(test, structure, sensors):
    """Displacement of the driven body's mass centre and its pitch, since the first reading.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    structure : Structure
    sensors : Sensors

    Returns
    -------
    values : float64 array, shape (n_times, 4)
        x, y, z [m] and pitch [rad]; NaN is a gap, or a direction that is not measured; a pitch that the markers do
        not tell is 0.
    noise : float64 array, shape (4,)
        Standard deviations [m, rad]; 0 of what is not told.
    """
    poses = body_poses(test, structure, sensors.marker_noise, asked=structure.driven)
    body = driven_body(structure, poses)
    turn = poses.rotation[:, body]
    first = int(np.flatnonzero(np.isfinite(poses.position[:, body, 0]))[0])
    against = turn @ turn[first].T
    pitch = 0.5 * (against[:, 0, 2] - against[:, 2, 0])
    moved = poses.position[:, body] - poses.position[first, body]
    noise = np.sqrt(np.diag(poses.covariance[body])[[0, 1, 2, 4]])
    if poses.known[body] == TRANSLATION:
        pitch, noise[3] = np.zeros(len(pitch)), 0.0
    untold = ~poses.told[body]
    moved[:, untold], noise[:3][untold] = np.nan, 0.0
    return np.column_stack([moved, pitch]), noise


def base_accelerometer(test, structure, axis):
    """`ChannelReadings` of the first accelerometer on a driven body along an axis; None where there is none."""
    channels = [str(name) for name in test["channel"].values] if "accelerometer" in test else []
    driven = {body.name for body in structure.file.bodies if body.driven}
    for sensor in structure.file.accelerometers:
        if sensor.body in driven and f"{sensor.name}-{axis}" in channels:
            readings = test["accelerometer"].transpose("time_acc", "channel").to_numpy()
            return ChannelReadings(
                test["time_acc"].to_numpy(), readings[:, channels.index(f"{sensor.name}-{axis}")]
            )
    return None
