"""From the readings of a test to the forces in its joints: the one way, for measured and simulated tests alike."""

from dataclasses import dataclass

import numpy as np

from blockshake.forces.faces import find_faces
from blockshake.forces.joint_motion import JointMotion, joint_motion
from blockshake.forces.least_force import LeastForce, least_force
from blockshake.forces.motion import WIDTH, Motion, is_short, smooth_motion
from blockshake.forces.quiet_start import counted_from_rest
from blockshake.forces.required import RequiredWrenches, required_wrenches
from blockshake.forces.transmitted import TransmittedForces, transmitted_forces
from blockshake.geometry.structure import Structure
from blockshake.measurement.motion.body_poses import PLANAR, POSE, TRANSLATION, body_poses

_STEP = 0.01  # s, between instants: less than the kernel's width
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
    sensors = sensors.not_noiseless()
    test, until = counted_from_rest(test, structure, sensors)
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
