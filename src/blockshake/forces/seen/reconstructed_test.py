"""A test as its sensors show it: readings, motion, faces, states, forces and rows, each made once."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from blockshake.forces.faces import find_faces
from blockshake.forces.joint_motion import JointMotion, joint_motion
from blockshake.forces.motion import Motion, is_short, smooth_motion
from blockshake.forces.required import RequiredWrenches, required_wrenches
from blockshake.forces.seen.equilibrium_rows import (
    ContactForces,
    EquilibriumRows,
    FaceFrames,
    balanced_wrenches,
    bearing_points,
    contact_forces,
    equilibrium_rows,
    face_frames,
    with_resultants,
)
from blockshake.forces.seen.states import FaceStates, face_states
from blockshake.geometry.structure import Structure
from blockshake.measurement.sensors.quiet_start import counted_from_rest

_LEAST_STILL = 0.1  # s of rest before the table moves, from whose mean the readings count
_DRIFT, _SURE_DRIFT = 1e-3, 5.0  # m, standard deviations: between the halves of a rest
_MOTION = (
    "position", "velocity", "acceleration", "rotation", "angular_velocity", "angular_acceleration",
)  # fmt: skip


@dataclass(frozen=True)
class ReconstructedTest:
    """All that is read off a test, measured or simulated."""

    name: str
    structure: Structure
    # xarray.Dataset; as in a campaign's test file, faults of sensors and outliers taken out, counted from
    # rest
    readings: xr.Dataset
    motion: Motion
    # bool (n_times,); the quiet start; nowhere where there is none, and then no motion is known: readings
    # count from rest
    still: np.ndarray
    joints: JointMotion  # zero where it is not known: no face turns or slips there
    required: RequiredWrenches
    frames: FaceFrames
    states: FaceStates
    forces: ContactForces
    rows: EquilibriumRows

    @property
    def faces(self):
        """Contact faces of the structure at its start."""
        return self.frames.faces

    @cached_property
    def free(self):
        """Bodies that are not driven, int array."""
        return np.flatnonzero(~self.structure.driven)

    @property
    def tree(self):
        """Whether the faces are a tree: the force of each is known."""
        return len(self.faces) == len(self.free)

    @cached_property
    def balanced(self):
        """`balanced_wrenches` of the test."""
        return balanced_wrenches(self.rows, self.required, self.free)

    @cached_property
    def bearing(self):
        """Where every face bears, (n_times, n_faces, 3) [m]."""
        return bearing_points(self.frames, self.states)


def why_not_reconstructed(readings, structure):
    """Reason why a test cannot be seen, or None."""
    if is_short(readings):
        return "the test is too short"
    if any(solid.polyhedron is None for solid in structure.solids.values()):
        return "a shape is not convex"
    return None if structure.touching.any() else "no bodies touch"


def reconstruct_test(name, readings, structure, sensors):
    """`ReconstructedTest` of readings, an `xarray.Dataset` without sensors' faults and outliers, until a block
    falls."""
    sensors = sensors.not_noiseless()
    readings, until = counted_from_rest(readings, structure, sensors)
    motion = smooth_motion(readings, structure, sensors)
    still = motion.time <= until
    if not _rests(readings, until, sensors.marker_noise):
        still[:] = False
        motion = replace(
            motion,
            information=np.zeros_like(motion.information),
            **{name: np.full_like(getattr(motion, name), np.nan) for name in _MOTION},
        )
    faces = find_faces(structure)
    required = required_wrenches(structure, motion)
    joints = joint_motion(structure, faces, motion, still)
    frames, free = face_frames(structure, faces, motion), np.flatnonzero(~structure.driven)
    forces = contact_forces(frames, required, free)
    states = face_states(structure, faces, motion, joints, still)
    known = True
    if len(faces) == len(free):
        states = with_resultants(states, frames, forces, joints)
    else:
        forces = contact_forces(frames, required, free, states)
        known = np.isfinite(forces.force).all(
            axis=(1, 2)
        )  # without a body, errors of a loop's joints are not known
    joints = replace(
        joints, **{name: np.nan_to_num(getattr(joints, name)) for name in ("rotation", "roll", "slip_rate")}
    )
    rows = equilibrium_rows(frames, states, motion, required, free, known)
    return ReconstructedTest(
        name, structure, readings, motion, still, joints, required, frames, states, forces, rows
    )


def _rests(readings, until, noise):
    """Whether all markers are at rest for long enough before the table moves."""
    time = readings["time"].to_numpy()
    moved = readings["marker_displacement"].transpose("time", "marker", "axis").to_numpy()[time <= until]
    first, second = (np.ma.masked_invalid(half).mean(axis=0) for half in np.array_split(moved, 2))
    drift = np.ma.filled(np.abs(second - first), 0.0)
    return until - time[0] >= _LEAST_STILL and bool((drift < max(_DRIFT, _SURE_DRIFT * noise)).all())
