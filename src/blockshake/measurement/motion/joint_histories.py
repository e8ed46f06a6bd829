"""Histories of every joint and of every body in a test, measured or simulated, from the markers in the same way."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import rigid_jacobian
from blockshake.measurement.motion.body_poses import POSE, body_poses, driven_body
from blockshake.measurement.motion.joints import find_joints, joint_coordinates


def joint_histories(test, structure, sensors):
    """Slip, opening and rotation of every joint, and the displacement of every body, with their noise.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, counted from rest; a simulated run comes through `observe`.
    structure : Structure
        The campaign's, for a simulated run too, whatever was varied in it.
    sensors : Sensors
        Of the measured test, for a simulated one too.

    Returns
    -------
    xarray.Dataset
        ``slip(time, joint, tangent)``, ``opening(time, joint)`` [m] and ``rotation(time, joint, axis)`` [rad] as in
        `joint_coordinates`; ``body_displacement(time, body, axis)`` [m] against the driven body, in its frame. Each has
        ``NAME_noise``, the standard deviation of one value from the markers' noise, without the time. Coordinate
        ``known(body)`` as in `body_poses`.

    Notes
    -----
    NaN where a body was not read; a joint of a body whose rotation nobody can know is NaN throughout, and of a planar
    one the rotations about x and z. A direction that the markers of a body do not measure is NaN, of that body and of
    its joints; the others are found as if nothing moved along it, which errs by the products of small motions. With
    markers on a line a yaw of the table shows as a slip, and nothing distinguishes the two.
    """
    poses = body_poses(test, structure, sensors.marker_noise)
    driven = driven_body(structure, poses)
    # joint_coordinates counts from its first time: give it the mean pose of the structure file
    position = np.concatenate([structure.position[None], poses.position])
    rotation = np.concatenate([rotation_matrices(structure.orientation)[None], poses.rotation])
    histories = joint_coordinates(structure, position, rotation).isel(time=slice(1, None))
    seen = np.einsum("tij,tbi->tbj", rotation[:, driven], position - position[:, driven, None])
    histories["body_displacement"] = ("time", "body", "axis"), seen[1:] - seen[:1], {"units": "m"}
    whole = np.array([known == POSE for known in poses.known])
    pairs = find_joints(structure)[0]
    # what a planar pose takes as none is not known
    planar = ~whole[pairs].all(axis=1)
    histories["rotation"][:, planar, [0, 2]] = np.nan
    of_joints = poses.axes_read[pairs].all(axis=1)
    for name, known in (
        ("slip", of_joints[:, :2]),
        ("opening", of_joints[:, 2]),
        ("body_displacement", poses.axes_read & poses.axes_read[driven]),
    ):
        histories[name][:] = np.where(known, histories[name], np.nan)
    return histories.assign(_noise(structure, poses, driven)).assign_coords(
        time=("time", test["time"].to_numpy(), {"units": "s"}),
        body=structure.body_names,
        known=("body", poses.known),
    )


def _noise(structure, poses, driven):
    """Standard deviations by first-order propagation of the poses' covariances."""
    pairs, centres = find_joints(structure)
    turns = rotation_matrices(structure.orientation)

    def relative(lower, upper, point):
        if lower == upper:  # of one body against itself: nothing
            return np.zeros(6)
        of_upper = _at_point(poses.covariance[upper], point - structure.position[upper])
        of_lower = _at_point(poses.covariance[lower], point - structure.position[lower])
        turn = np.kron(np.eye(2), turns[lower].T)
        return np.sqrt(np.diag(turn @ (of_upper + of_lower) @ turn.T))

    of_joints = np.array([relative(*pair, centre) for pair, centre in zip(pairs, centres, strict=True)])
    of_bodies = np.array(
        [relative(driven, body, centroid) for body, centroid in enumerate(structure.position)]
    )
    return {
        "slip_noise": (("joint", "tangent"), of_joints[:, :2]),
        "opening_noise": ("joint", of_joints[:, 2]),
        "rotation_noise": (("joint", "axis"), of_joints[:, 3:]),
        "body_displacement_noise": (("body", "axis"), of_bodies[:, :3]),
    }


def _at_point(covariance, arm):
    """Covariance of the displacement of a body's point and of its rotation, (6, 6)."""
    change = np.vstack([rigid_jacobian(arm[None]), np.eye(6)[3:]])
    return change @ covariance @ change.T
