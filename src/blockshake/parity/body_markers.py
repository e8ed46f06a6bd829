"""Markers of one body in the tests that are read together, and the pose that they give."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_opening

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.motion.body_frame import ON_LINE, outlying, rigid_jacobian, see_from_body
from blockshake.measurement.sensors.markers import whole_markers

FEWEST_MARKERS = 3  # of a body, whose residual shows anything
LARGEST_ROTATION = 0.3  # rad; a body that lies on its side is no longer checked
LARGEST_MAGNIFICATION = 3.0  # noise of the sensor's point over a marker's, above which nothing is compared
LARGEST_UNSEEN_ARM = 0.1  # m per rad
_LARGEST_GAP = 2  # readings that interpolation bridges


@dataclass(frozen=True)
class BodyMarkers:
    """Markers of one body."""

    markers: tuple  # of str
    points: np.ndarray  # float64 (n_markers, 3); body frame [m]
    box: np.ndarray  # float64 (2, 3); ends of the body along its own axes, from its centroid [m]
    # position, rotation: float64 (n_tests, 3), (n_tests, 3, 3); pose at rest in each test; of one test, see
    # `in_test`, (3,) and (3, 3)
    position: np.ndarray
    rotation: np.ndarray
    noise: np.ndarray  # float64 (3,); of a reading along the axes of the body, over the usual one [1]
    tests: tuple  # of str
    # of (time, displacement); times [s] and readings (n_times, n_markers, 3) of each test, inertial frame [m]
    readings: list

    @classmethod
    def of(cls, structure, body, tests, names, axes=(1.0, 1.0, 1.0)):
        """Markers of a body, where ``names`` has them, in ``tests`` (readings by name); ``axes`` as of `Sensors`."""
        starts = [initial_poses(structure, test) for test in tests.values()]
        markers = [
            marker for marker in structure.file.markers if marker.body == body and marker.name in names
        ]
        carried, index = [marker.name for marker in markers], structure.body_names.index(body)
        displacements = [test["marker_displacement"].sel(marker=carried) for test in tests.values()]
        return cls(
            tuple(carried),
            np.array([marker.position for marker in markers], dtype=float).reshape(-1, 3),
            np.array([extent(structure.solid(index).vertices, axis=0) for extent in (np.min, np.max)]),
            np.array([start.position[index] for start in starts]),
            rotation_matrices([start.orientation[index] for start in starts]),
            np.sqrt(rotation_matrices(structure.orientation[index]).T ** 2 @ np.array(axes) ** 2),
            tuple(tests),
            [
                (moved["time"].to_numpy(), moved.transpose("time", "marker", "axis").to_numpy())
                for moved in displacements
            ],
        )

    def in_test(self, number=0):
        """The body in the test of this number alone."""
        start = {"position": self.position[number], "rotation": self.rotation[number]}
        return replace(self, **start, tests=self.tests[number:][:1], readings=self.readings[number:][:1])

    def frame(self, displacement, offset=0.0):
        """`BodyFrame` of displacements of the markers, these as far off their points as ``offset`` (body frame) [m]."""
        points = self.points + offset
        readings = self.position + points @ self.rotation.T + displacement
        return see_from_body(points, readings, self.position, self.rotation, self.noise)

    def upright(self, rotation):
        """Times at which the body is known not to have turned far, bool (n_times,)."""
        return np.einsum("tij,ij->t", rotation, self.rotation) > 1.0 + 2.0 * np.cos(LARGEST_ROTATION)


def bodies_with_markers(structure, tests, axes=(1.0, 1.0, 1.0)):
    """`BodyMarkers` of every body that has three markers, with all directions measured, in all tests, by its name.

    A marker that no test reads, one whose readings were left out, is none.
    """
    shared = set.intersection(*(set(whole_markers(test)) for test in tests.values()))
    shared &= {str(name) for test in tests.values() for name in _read(test)}
    bodies = {name: BodyMarkers.of(structure, name, tests, shared, axes) for name in structure.body_names}
    return {name: body for name, body in bodies.items() if len(body.markers) >= FEWEST_MARKERS}


def _read(test):
    """Names of the markers of which anything was read."""
    return test["marker"].values[np.isfinite(test["marker_displacement"]).any(["time", "axis"])]


class MeasuredPose(NamedTuple):
    """Pose of a body in one test."""

    points: np.ndarray  # float64 (n_markers, 3); of its markers, body frame [m]
    time: np.ndarray  # float64 (n_times,); even [s]
    # position, rotation: float64 (n_times, 3), (n_times, 3, 3); NaN where gaps are too long
    position: np.ndarray
    rotation: np.ndarray
    read: np.ndarray  # bool (n_times, n_markers)


def measured_pose(body, test):
    """`MeasuredPose` of `BodyMarkers` in the test of this number, outliers left out; None where too little was read."""
    body = body.in_test(test)
    ((time, displacement),) = body.readings
    first = body.frame(displacement)
    displacement = np.where(outlying(first.residual)[..., None], np.nan, displacement)
    # steps where a marker comes or goes would look like acceleration
    mean = np.ma.masked_invalid(first.residual).mean(axis=0).filled(0.0)
    displacement -= np.einsum("tij,mj->tmi", np.nan_to_num(first.rotation), mean)
    pose = body.frame(displacement)
    known = body.upright(pose.rotation)
    if known.sum() < 2:
        return None
    even = np.linspace(time[0], time[-1], len(time))
    flat = np.concatenate([pose.position, pose.rotation.reshape(-1, 9)], axis=1)
    gap = binary_opening(~known, np.ones(_LARGEST_GAP + 1))
    flat = np.stack([np.interp(even, time[known], values[known]) for values in flat.T], axis=1)
    flat[np.interp(even, time, gap) > 0.0] = np.nan
    read = np.isfinite(displacement).all(axis=2)
    return MeasuredPose(body.points, even, flat[:, :3], flat[:, 3:].reshape(-1, 3, 3), read)


def sight(points, point, direction):
    """Noise and visibility of a point's motion along a direction of its body, as the markers give it.

    Returns
    -------
    magnified : float
        Its noise over that of a marker [1].
    unseen : float
        Its motion along the direction in a unit turn that the markers do not show [m].
    """
    jacobian = rigid_jacobian(points - points.mean(axis=0))
    row = direction @ rigid_jacobian((np.array(point, dtype=float) - points.mean(axis=0))[None])
    inverse = np.linalg.pinv(jacobian, rcond=ON_LINE)
    return np.linalg.norm(row @ inverse), np.linalg.norm(row - row @ inverse @ jacobian)
