"""Channels of accelerometers against gravity at rest, and against the markers of their block."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.clocks import RELATED
from blockshake.measurement.checks.against_slab import banded, seen, unfit
from blockshake.measurement.motion.body_poses import body_poses
from blockshake.measurement.sensors.accelerometers import channel_carriers

_ALIKE = 0.1  # of gravity's size, within which a reading at rest is gravity's
_OTHER = 0.5  # of gravity's size, by which it is not that of the channel's axis


def gravity_remarks(test, structure, until):
    """Remarks on channels whose reading at rest is gravity along another axis, or upside down.

    A channel with a constant part reads the specific force, +9.81 m/s2 along an upward axis; one without reads 0. Both
    are right. ``until``: end of the rest on the clock of the accelerometers [s].
    """
    gravity = np.array(structure.file.gravity)
    size = np.linalg.norm(gravity)
    rest = test["accelerometer"].isel(time_acc=(test["time_acc"] < until).to_numpy())
    start = rotation_matrices(structure.orientation)
    turned, aside = [], []
    for name, (body, axis) in channel_carriers(structure).items():
        if name not in test["channel"].values or not rest.sel(channel=name).notnull().any():
            continue
        read = float(rest.sel(channel=name).median())
        right = -start[structure.body_names.index(body), :, "xyz".index(axis)] @ gravity
        if abs(abs(read) - size) < _ALIKE * size and abs(read - right) > _OTHER * size:
            (turned if abs(right) > _OTHER * size else aside).append((name, read))
    remarks = []
    for found, wrong in (
        (turned, "where gravity has the other sign: reverse {}"),
        (aside, "as along the vertical, which is not its axis: map {} as the channel that it is"),
    ):
        if found:
            them = "it" if len(found) == 1 else "them"
            remarks.append(f"{_names(found)} {found[0][1]:.3g} m/s2 at rest, {wrong.format(them)}")
    return remarks


def reversed_remarks(test, structure, noise, lag):
    """Remarks on channels of blocks that read the opposite of what the markers of their block do, in 1 to 8 Hz.

    Parameters
    ----------
    test : xarray.Dataset
        From `load_test`.
    structure : Structure
    noise : float
        Standard deviation of a marker's reading [m].
    lag : float
        By how much the accelerometers' times are too late [s].
    """
    poses, time = body_poses(test, structure, noise), test["time"].to_numpy()
    time_acc = test["time_acc"].to_numpy() - lag
    start, gravity = rotation_matrices(structure.orientation), np.array(structure.file.gravity)
    found = []
    for sensor, arm in zip(
        structure.file.accelerometers, structure.arms(structure.file.accelerometers), strict=True
    ):
        body = structure.body_names.index(sensor.body)
        for axis in sensor.axes:
            name, index = f"{sensor.name}-{axis}", "xyz".index(axis)
            along = start[body, :, index]
            unread = np.abs(along[~poses.axes_read[body]]).any()
            if name not in test["channel"].values or structure.driven[body] or unread:
                continue
            read = test["accelerometer"].sel(channel=name).to_numpy()
            moved = (poses.position[:, body] + poses.rotation[:, body] @ arm) @ along
            weight = -poses.rotation[:, body, :, index] @ gravity
            if unfit(time, moved) or unfit(time_acc, read):
                continue
            felt = np.gradient(np.gradient(banded(time, moved), time), time)
            known = (time >= max(time[0], time_acc[0])) & (time <= min(time[-1], time_acc[-1]))
            if not seen(felt[known], time, noise):
                continue
            felt, read = (
                (felt + banded(time, weight))[known],
                np.interp(time[known], time_acc, banded(time_acc, read)),
            )
            correlation = felt @ read / np.sqrt((felt @ felt) * (read @ read))
            if correlation < -RELATED:
                found.append((name, correlation))
    if not found:
        return []
    what = "of their blocks do: reverse them" if len(found) > 1 else "of its block do: reverse it"
    weakest = max(correlation for _, correlation in found)
    return [f"{_names(found)} the opposite of what the markers {what} (correlation {weakest:.2f})"]


def _names(found):
    names = [name for name, _ in found]
    return f"{names[0]} reads" if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]} read"
