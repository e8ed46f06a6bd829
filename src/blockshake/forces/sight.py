"""Sight of a campaign: the joints whose levers its sensors will show, and how sharply, before anything is simulated."""

import numpy as np

from blockshake.forces.joint_forces import gives_forces, joint_forces
from blockshake.forces.motion import is_short
from blockshake.geometry.schema import AXES
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.motion.body_poses import PLANAR, POSE, body_poses
from blockshake.measurement.motion.outliers import without_outliers

_LONGEST = 2.0  # s of a test that are read: errors of levers hardly change along it


def sight_lines(campaign):
    """Lines that say what joint forces the sensors of the first open test give.

    Parameters
    ----------
    campaign : Campaign

    Returns
    -------
    list of str
        Empty without an open test. Errors of levers are standard deviations at one instant, the kernel's smoothing
        in them.
    """
    structure = load_structure(campaign.structure)
    name = next((one.name for one in campaign.tests.values() if one.role != "sealed"), None)
    if name is None:
        return []
    test = without_outliers(load_test(campaign, name), structure)
    start = float(test["time"][0])
    test = test.isel(time=test["time"].to_numpy() < start + _LONGEST)
    if "time_acc" in test.dims:
        test = test.isel(time_acc=test["time_acc"].to_numpy() < start + _LONGEST)
    if not gives_forces(test, structure, campaign.sensors):
        return [
            f"joint forces: none, {_hindrance(test, structure, campaign.sensors)}; whole tests alone are judged"
        ]
    forces = joint_forces(test, structure, campaign.sensors)
    faces = forces.transmitted.faces
    errors = np.nanmedian(forces.transmitted.lever_error, axis=0)
    seen = [f"{face.name} to {1e3 * error:.2g} mm" for face, error in zip(faces, errors, strict=True)]
    lines = [f"joint forces: lever seen of {', '.join(seen)}"] if seen else []
    others = [face.name for face in forces.faces if face not in faces]
    if others:
        lines.append(f"joint forces: unexplained force alone, no lever, of {', '.join(others)}")
    return lines


def _hindrance(test, structure, sensors):
    """Reason why there are none."""
    if is_short(test):
        return "the first open test is too short"
    if any(solid.polyhedron is None for solid in structure.solids.values()):
        return "a shape is not convex"
    if not structure.touching.any():
        return "no bodies touch"
    poses = body_poses(test, structure, sensors.marker_noise)
    unread = [
        name
        for name, one, driven in zip(structure.body_names, poses.known, structure.driven, strict=True)
        if one not in (POSE, PLANAR) and not driven
    ]
    if unread or poses.told.all():
        return f"the rotation of {', '.join(unread) or 'the table'} is not read"
    body = int(np.argmin(poses.told.all(axis=1)))
    axes = " and ".join(axis for axis, told in zip(AXES, poses.told[body], strict=True) if not told)
    return f"the displacement of {structure.body_names[body]} along {axes} is not read"
