"""Markers of two bodies that a map has exchanged, by the motion of a test."""

import numpy as np

from blockshake.measurement.checks.joint_fit import ABOVE_NOISE, exchanged_bodies, joint_fit
from blockshake.measurement.motion.body_poses import TRANSLATION, body_poses
from blockshake.measurement.motion.fall import find_fall, until_fall

_LEAST = 2e-3  # m rms against the slab, of a block that is looked at
_LESS = 0.7  # of the lower block's motion against the slab; blocks that rock together have 1.1 and more
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
