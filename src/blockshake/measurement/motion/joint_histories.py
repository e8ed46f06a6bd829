"""Histories of joints and bodies in the plane of shaking, of measured and simulated tests in the same way."""

import numpy as np
import xarray as xr

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import rigid_jacobian
from blockshake.measurement.motion.body_poses import body_poses, driven_body
from blockshake.measurement.motion.joints import find_joints, joint_coordinates


def joint_histories(test, structure, sensors):
    """Slip along x and rotation about y of every joint, and drift along x of every body, with their noise.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, counted from rest; a simulated run comes through `observe`.
    structure : Structure
        The campaign's, for a simulated run too, whatever was varied in it.
    sensors : Sensors
        Sensors of the measured test, for a simulated one too.

    Returns
    -------
    xarray.Dataset
        ``slip(time, joint)``, ``opening(time, joint)`` [m] and ``rotation(time, joint)`` [rad] as in
        `joint_coordinates`; ``drift(time, body)`` [m], displacement against the driven body, in its frame. Each but the
        opening has ``NAME_noise``, the standard deviation of one value from the markers' noise, without the time.

    Notes
    -----
    NaN where a body was not read, and for a joint of a body whose rotation nobody can know. Where the markers of a body
    do not measure x, its drift and the slips of its joints are NaN, and without z their openings. Motions that nobody
    measured count as none in the others, which errs by the products of small motions. With markers on a line a yaw of
    the table shows as a slip, and nothing distinguishes the two.
    """
    poses = body_poses(test, structure, sensors.marker_noise)
    driven = driven_body(structure, poses)
    # joint_coordinates counts from its first time: give it the mean pose of the structure file
    position = np.concatenate([structure.position[None], poses.position])
    rotation = np.concatenate([rotation_matrices(structure.orientation)[None], poses.rotation])
    joints = joint_coordinates(structure, position, rotation).isel(time=slice(1, None))
    seen = np.einsum("tij,tbi->tbj", rotation[:, driven], position - position[:, driven, None])[..., 0]
    along = poses.axes_read[:, 0]
    pairs = find_joints(structure)[0]
    slips, lifts = (xr.DataArray(poses.axes_read[pairs, axis].all(axis=1), dims="joint") for axis in (0, 2))
    drift = np.where(along & along[driven], seen[1:] - seen[:1], np.nan)
    return xr.Dataset(
        {
            "slip": joints["slip"].sel(tangent="x", drop=True).where(slips),
            "opening": joints["opening"].where(lifts),
            "rotation": joints["rotation"].sel(axis="y", drop=True),
            "drift": (("time", "body"), drift, {"units": "m"}),
            **_noise(structure, poses, driven),
        },
        {"time": ("time", test["time"].to_numpy(), {"units": "s"}), "body": structure.body_names},
    ).drop_vars(["lower", "upper"])


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
        "slip_noise": ("joint", of_joints[:, 0]),
        "rotation_noise": ("joint", of_joints[:, 4]),
        "drift_noise": ("body", of_bodies[:, 0]),
    }


def _at_point(covariance, arm):
    """Covariance of the displacement of a body's point and of its rotation, (6, 6)."""
    change = np.vstack([rigid_jacobian(arm[None]), np.eye(6)[3:]])
    return change @ covariance @ change.T
