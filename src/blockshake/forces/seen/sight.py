"""Sight of a campaign: the joints whose levers its sensors will show, and how sharply, before anything is judged."""

import numpy as np

from blockshake.forces.seen.reconstructed_test import reconstruct_test, why_not_reconstructed
from blockshake.geometry.schema import AXES
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.body_poses import PLANAR, POSE, body_poses

_LONGEST = 2.0  # s of a test that are read: errors of levers hardly change along it


def sight_lines(campaign):
    """Lines of text that say what joint forces the sensors of the first open test give; none without an open test.

    Errors of levers are standard deviations at one instant, the kernel's smoothing in them.
    """
    structure = load_structure(campaign.structure)
    name = next(iter(campaign.open), None)
    if name is None:
        return []
    test = load_test(campaign, name, structure)
    structure = initial_poses(structure, test)
    test = without_outliers(test, structure)
    start = float(test["time"][0])
    test = test.isel(time=test["time"].to_numpy() < start + _LONGEST)
    if "time_acc" in test.dims:
        test = test.isel(time_acc=test["time_acc"].to_numpy() < start + _LONGEST)
    if hindrance := why_not_reconstructed(test, structure) or _unread(
        test, structure, campaign.sensors.marker_noise
    ):
        return [f"joint forces: none, {hindrance}"]
    seen = reconstruct_test(name, test, structure, campaign.sensors)
    if not seen.tree:
        return ["joint forces: sums over the joints that turn, the lever of none: more joints than blocks"]
    errors = np.nanmedian(seen.forces.moment_error / np.abs(seen.forces.force[..., 2]), axis=0)
    levers = [f"{face.name} to {1e3 * error:.2g} mm" for face, error in zip(seen.faces, errors, strict=True)]
    return [f"joint forces: lever seen of {', '.join(levers)}"]


def _unread(test, structure, noise):
    """Body of which too little is read, and what, or None."""
    poses = body_poses(test, structure, noise)
    turning = [
        name
        for name, known, driven in zip(structure.body_names, poses.known, structure.driven, strict=True)
        if known not in (POSE, PLANAR) and not driven
    ]
    if turning:
        return f"the rotation of {', '.join(turning)} is not read"
    if poses.axes_read.all():
        return None
    body = int(np.argmin(poses.axes_read.all(axis=1)))
    axes = " and ".join(axis for axis, read in zip(AXES, poses.axes_read[body], strict=True) if not read)
    return f"the displacement of {structure.body_names[body]} along {axes} is not read"
