"""From the readings of a test to the forces in its joints: the one way, for measured and simulated tests alike."""

from dataclasses import dataclass

import numpy as np

from blockshake.forces.faces import find_faces
from blockshake.forces.joint_motion import JointMotion, joint_motion
from blockshake.forces.least_force import LeastForce, least_force
from blockshake.forces.local_fit import REACH
from blockshake.forces.motion import WIDTH, Motion, smooth_motion
from blockshake.forces.required import RequiredWrenches, required_wrenches
from blockshake.forces.transmitted import TransmittedForces, transmitted_forces
from blockshake.geometry.structure import Structure
from blockshake.measurement.motion.body_poses import PLANAR, POSE, TRANSLATION, body_poses

_STEP = 0.01  # s, between instants: less than the kernel's width
_LONGEST_STILL = 0.5  # s
_STILL = 5.0  # standard deviations of a marker
# noise of the best instruments: a stated noise of 0 says that there is none to speak of
_LEAST_NOISE = {"marker_noise": 1e-6, "accelerometer_noise": 1e-4}  # m, m/s2
_ENOUGH = 20  # readings, by which the markers of each body are known


@dataclass(frozen=True)
class JointForces:
    """All that is computed of a test's forces.

    Attributes
    ----------
    structure : Structure
    faces : list of Face
        Of all joints.
    motion : Motion
    joints : JointMotion
    required : RequiredWrenches
    transmitted : TransmittedForces
        Of the joints that are statically determinate.
    least : LeastForce
    still : bool array, shape (n_times,)
        The quiet start.
    """

    structure: Structure
    faces: list
    motion: Motion
    joints: JointMotion
    required: RequiredWrenches
    transmitted: TransmittedForces
    least: LeastForce
    still: np.ndarray


def is_short(test):
    """Whether a test is too short for the smoothing kernel, to either side of half a second of instants."""
    return float(test["time"][-1] - test["time"][0]) < 2.0 * REACH * WIDTH + _LONGEST_STILL


def gives_forces(test, structure, sensors):
    """Whether forces can be computed: convex shapes, joints, and a motion read of every free body and the table.

    That is its rotation, and its displacement along all three directions, for longer than the kernel needs.
    """
    if is_short(test):
        return False
    if any(solid.polyhedron is None for solid in structure.solids.values()) or not structure.touching.any():
        return False
    first = test.isel(time=slice(0, _ENOUGH))
    poses = body_poses(first, structure, sensors.marker_noise)
    return poses.told.all() and all(
        one in ((POSE, PLANAR, TRANSLATION) if driven else (POSE, PLANAR))
        for one, driven in zip(poses.known, structure.driven, strict=True)
    )


def joint_forces(test, structure, sensors, width=WIDTH):
    """Forces of a test.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, without outliers.
    structure : Structure
    sensors : Sensors
    width : float
        Standard deviation of the smoothing kernel [s].

    Returns
    -------
    JointForces
        At instants 10 ms apart, those at the ends left out that the kernel does not cover.
    """
    sensors = sensors.model_copy(
        update={name: max(getattr(sensors, name), least) for name, least in _LEAST_NOISE.items()}
    )
    test, until = from_rest(test, structure, sensors)
    motion = smooth_motion(test, structure, sensors, _STEP, width)
    still = motion.time <= until
    faces = find_faces(structure)
    required = required_wrenches(structure, motion)
    joints = joint_motion(structure, faces, motion, still, width)
    return JointForces(
        structure, faces, motion, joints, required,
        transmitted_forces(structure, faces, motion, required),
        least_force(structure, faces, motion, joints, required), still,
    )  # fmt: skip


def from_rest(test, structure, sensors):
    """Readings counted from their means while the table was still, and the time until which it was."""
    names = [str(name) for name in test["marker"].values]
    driven = {body.name for body in structure.file.bodies if body.driven}
    own = [marker.name for marker in structure.file.markers if marker.body in driven and marker.name in names]
    moved = test["marker_displacement"].sel(marker=own, axis="x").to_numpy()
    time = test["time"].to_numpy()
    moved = moved[:, np.isfinite(moved[:10]).any(axis=0)]
    moving = (np.abs(moved - np.nanmedian(moved[:10], axis=0)) > _STILL * sensors.marker_noise).all(axis=1)
    moving &= moved.shape[1] > 0
    end = time[int(np.argmax(moving))] if moving.any() else time[-1]
    until = float(min(end, time[0] + _LONGEST_STILL))
    rest = test["marker_displacement"].isel(time=time <= until).mean("time").fillna(0.0)
    counted = {"marker_displacement": test["marker_displacement"] - rest}
    if "accelerometer" in test:
        before = test["time_acc"].to_numpy() <= until
        counted["accelerometer"] = test["accelerometer"] - test["accelerometer"].isel(time_acc=before).mean(
            "time_acc"
        )
    return test.assign(counted), until
