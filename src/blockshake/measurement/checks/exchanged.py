"""Markers of two bodies that a map has exchanged, by the motion of a test."""

import itertools

import numpy as np

from blockshake.geometry.schema import AXES
from blockshake.measurement.checks.joint_fit import ABOVE_NOISE, exchanged_bodies, joint_fit
from blockshake.measurement.motion.body_poses import POSE, TRANSLATION, body_poses
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.sensors.markers import marker_bodies, marker_position

_LEAST = 2e-3  # m rms against the slab, of a block that is looked at
_LESS = 0.7  # of the lower block's motion against the slab; blocks that rock together have 1.1 and more
_MOST_ROWS, _MISFIT = 200, 5.0  # times the noise of a reading, of a misfit that is looked at
_FITS = 0.3  # of the misfit to a rigid body
_ASIDE = 3.0  # times the motion along z, that blocks shaken along x do not move along y
_CLOSER = 0.25  # of the slab's mean square deviation from the command


def exchange_remarks(test, structure, sensors, target):
    """Remarks on two blocks, or a block and the slab, that move as the other one should.

    Parameters
    ----------
    test : xarray.Dataset
        From `load_test`.
    structure : Structure
    sensors : Sensors
    target : float64 array, shape (n_times,), or None
        Commanded displacement along x [m].

    Notes
    -----
    Blocks whose rotation is known are held against each other at their joints. Of others the upper one moves more
    against the slab than the lower one on which it stands, as a column rocks, if the two change places.
    """
    noise = sensors.marker_noise
    poses = body_poses(test, structure, noise)
    names, moved = structure.body_names, poses.position[..., 0] - structure.position[:, 0]
    remarks = _slab_exchanged(moved, target, structure, poses, noise)
    whole = until_fall(test, find_fall(test, structure, sensors)).sizes["time"]
    free = [body for body in range(len(names)) if not structure.driven[body]]
    fit = joint_fit(structure, poses.position[:whole], poses.rotation[:whole])
    remarks += _aside(test.isel(time=slice(whole)), structure, poses, noise)
    remarks += _not_rigid(test.isel(time=slice(whole)), structure, poses, noise)
    found = exchanged_bodies(
        fit, [body for body in free if np.isfinite(poses.rotation[:, body]).any()], noise
    )
    if found:
        slide = f"blocks would slide by {1e3 * fit.slip() ** 0.5:.2g} mm rms in their joints"
    else:
        found, slide = _upside_down(moved[:whole], structure, poses, noise)
    if found:
        one, other = (names[body] for body in found)
        remarks.append(
            f"{one} moves as {other} should, and {other} as {one}: are their markers exchanged? {slide}"
        )
    return remarks


def _not_rigid(test, structure, poses, noise):
    """A remark on a body whose markers fit a rigid one with an axis reversed, or two markers exchanged, alone."""
    rows = np.unique(np.linspace(0, test.sizes["time"] - 1, _MOST_ROWS).astype(int))
    test = test.isel(time=rows)
    names, on = test["marker"].values, np.array(marker_bodies(structure, test["marker"].values))
    whole = [name for body, name in enumerate(structure.body_names) if poses.known[body] == POSE]
    given = {name: _misfit(test, structure, name, noise) for name in whole}
    least = _MISFIT * noise
    for body in [name for name in whole if given[name] > least]:
        for axis in reversed(AXES):  # x reversed would show against the slab too
            turned = test.copy(deep=True)
            turned["marker_displacement"].loc[{"marker": names[on == body], "axis": axis}] *= -1.0
            if _misfit(turned, structure, body, noise) < _FITS * given[body]:
                return [f"the markers of {body} move as on a rigid body with {axis} reversed alone"]
        others = [name for name in whole if given[name] > least and name != body]
        for one, other in itertools.product(names[on == body], names[np.isin(on, others)]):
            swap = {one: other, other: one}
            swapped = test.assign_coords(marker=[swap.get(name, name) for name in names])
            if _misfit(swapped, structure, body, noise) < _FITS * given[body]:
                return [
                    f"{one} moves as {other} should: are the two exchanged? Others are then on a rigid body"
                ]
    return []


def _aside(test, structure, poses, noise):
    """A remark on blocks that move along y far more than along z, unless one is rigid only as the axes are."""
    names, on = test["marker"].values, np.array(marker_bodies(structure, test["marker"].values))
    free = [name for body, name in enumerate(structure.body_names) if not structure.driven[body]]
    read = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()[:, np.isin(on, free)]
    known = np.isfinite(read)
    squares = np.where(known, read, 0.0) ** 2
    rms = np.sqrt(squares.sum(axis=(0, 1)) / np.maximum(known.sum(axis=(0, 1)), 1))
    if not known[..., 2].any() or rms[1] <= max(_ASIDE * rms[2], ABOVE_NOISE * noise):
        return []
    rows = np.unique(np.linspace(0, test.sizes["time"] - 1, _MOST_ROWS).astype(int))
    few = test.isel(time=rows)
    swapped = few.assign(marker_displacement=few["marker_displacement"].copy())
    swapped["marker_displacement"].loc[{"marker": names[np.isin(on, free)]}] = (
        few["marker_displacement"].sel(marker=names[np.isin(on, free)], axis=["x", "z", "y"]).to_numpy()
    )
    for name in free:
        if poses.known[structure.body_names.index(name)] == POSE:
            other = _misfit(swapped, structure, name, noise)
            if other > _MISFIT * noise and _misfit(few, structure, name, noise) < _FITS * other:
                return []
    return [f"the blocks move by {1e3 * rms[1]:.2g} mm along y and {1e3 * rms[2]:.2g} mm along z (rms): "
            "are y and z swapped?"]  # fmt: skip


def _misfit(test, structure, body, noise):
    """Root mean square distance of a body's markers from those of the rigid body that fits best [m]."""
    index = structure.body_names.index(body)
    mine = test.isel(marker=np.flatnonzero(np.array(marker_bodies(structure, test["marker"].values)) == body))
    poses = body_poses(mine, structure, noise, np.arange(len(structure.mass)) == index)
    markers = {marker.name: np.array(marker.position) for marker in structure.file.markers}
    start = marker_position(structure, structure.position, structure.orientation)
    places = dict(zip(markers, start, strict=True))
    off = []
    for name in mine["marker"].values:
        arm = markers[name] - structure.mass_offset[index]
        read = (
            mine["marker_displacement"].sel(marker=name).transpose("time", "axis").to_numpy() + places[name]
        )
        off.append(read - poses.position[:, index] - poses.rotation[:, index] @ arm)
    return float(np.sqrt(np.nanmean(np.array(off) ** 2)))


def _upside_down(moved, structure, poses, noise):
    """Two blocks, one on the other, that change the order of a column in which all move more the higher they stand."""
    driven = np.flatnonzero(structure.driven)[0]
    against = moved - moved[:, [driven]]
    known = np.isfinite(against)
    size = np.sqrt(np.where(known, against**2, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1))
    height = structure.centroid[:, 2]
    below = {
        body: [other for other in np.flatnonzero(structure.touching[body]) if height[other] < height[body]]
        for body in np.flatnonzero(~structure.driven)
    }
    alone = {body: low[0] for body, low in below.items() if len(low) == 1 and not structure.driven[low[0]]}
    for high, low in alone.items():
        if not all(poses.known[body] == TRANSLATION and poses.axes_read[body, 0] for body in (low, high)):
            continue
        if size[low] < max(_LEAST, ABOVE_NOISE * noise) or size[high] > _LESS * size[low]:
            continue
        swapped = size.copy()
        swapped[[low, high]] = swapped[[high, low]]
        if all(swapped[one] >= swapped[other] for one, other in alone.items()):
            words = f"the upper one moves by {size[high] / size[low]:.2g} of the lower one against the slab"
            return (int(low), int(high)), words
    return None, ""


def _slab_exchanged(moved, target, structure, poses, noise):
    """A remark on a block that follows the command far more closely than the slab."""
    driven = np.flatnonzero(structure.driven)[0]
    if target is None or not poses.axes_read[driven, 0]:
        return []
    off = {}
    for body in np.flatnonzero(poses.axes_read[:, 0]):
        known = np.isfinite(moved[:, body])
        command = target[known] - target[known].mean()
        read = moved[known, body] - moved[known, body].mean()
        if not command.any():
            return []
        off[body] = ((read - (read @ command) / (command @ command) * command) ** 2).mean()
    closest = min(off, key=off.get)
    if off[driven] < (ABOVE_NOISE * noise) ** 2 or off[closest] > _CLOSER * off[driven]:
        return []
    names = structure.body_names
    return [
        f"{names[closest]} follows the command more closely than {names[driven]}: are their markers exchanged?"
    ]
