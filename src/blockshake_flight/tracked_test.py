"""Tests of poses of a campaign, each read once, and where the lowest points of the body are."""

from dataclasses import dataclass

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.motion.pose_columns import free_body
from blockshake_flight.pose_file import read_poses

CLEAR = 0.03  # of the body's radius: farther from the ground than tracked corners sink into it at impacts
_SUNK, _SHARE = 0.15, 0.05  # of the radius; of the readings, which no tracking error leaves deeper


@dataclass(frozen=True)
class TrackedTest:
    """One test of a body over a level ground."""

    name: str
    time: np.ndarray  # float64 (n_times,); from the first reading [s]
    # float64 (n_times, 3); of the shape's centroid, world frame [m]; NaN along an axis that was not filmed,
    # and in gaps
    position: np.ndarray
    rotation: np.ndarray  # float64 (n_times, 3, 3); body to world
    planar: bool  # filmed in the plane of x and z alone

    @property
    def axes(self):
        """Numbers of the axes that were filmed."""
        return np.flatnonzero(np.isfinite(self.position).any(axis=0))


@dataclass(frozen=True, eq=False)
class TrackedCampaign:
    """Tests of one body, and what it is."""

    structure: Structure
    tests: list  # of PosedTest
    body: int  # index of the free body
    vertices: np.ndarray  # float64 (n_vertices, 3); of the free body from its centroid, body frame [m]
    ground: float  # height of the ground [m]

    @property
    def radius(self):
        """Distance of the farthest vertex from the centroid [m]."""
        return float(np.linalg.norm(self.vertices, axis=1).max())

    @property
    def name(self):
        """The free body."""
        return self.structure.body_names[self.body]

    def heights(self, test):
        """Heights of the vertices over the ground, (n_times, n_vertices) [m]."""
        return test.position[:, 2, None] + test.rotation[:, 2] @ self.vertices.T - self.ground


def load_tracked(campaign, names):
    """`TrackedCampaign` of the named tests of a campaign without base motion.

    Raises
    ------
    InputError
        As of `read_poses`; or the body lies below the ground, or ends at rest above it.
    """
    structure = load_structure(campaign.structure)
    body, ground = free_body(structure)
    solid = structure.solids[structure.file.bodies[body].shape]
    top = structure.position[ground, 2] + structure.solid(ground).vertices[:, 2].max()
    found = TrackedCampaign(structure, [], body, solid.polyhedron.vertices, float(top))
    for name in names:
        path = campaign.folder / campaign.tests[name].file
        read = read_poses(path, structure)
        test = TrackedTest(
            name, read["time"].to_numpy(), read["position"].to_numpy(), read["rotation"].to_numpy(),
            bool(read.attrs["planar"]),
        )  # fmt: skip
        lowest = np.nanquantile(found.heights(test).min(axis=1), _SHARE)
        if lowest < -_SUNK * found.radius:
            raise InputError(
                path, f"{found.name}.z",
                f"expected the height of the centroid, z up, over a ground at {found.ground:g} m, and rotations from "
                f"body to world; the body lies {-1e3 * lowest:.3g} mm below the ground in one of 20 readings",
            )  # fmt: skip
        rest = _rests_at(found, test)
        if rest > _SUNK * found.radius:
            raise InputError(
                path, f"{found.name}.z",
                f"expected heights in metres over a ground at {found.ground:g} m; the body ends at rest "
                f"{1e3 * rest:.3g} mm above the ground",
            )  # fmt: skip
        found.tests.append(test)
    return found


def _rests_at(tracked, test):
    """Height of the lowest point at the end of a test [m]; zero where the body moves or may fly there.

    A flying body rises or falls by more than ``h`` within ``2 sqrt(2 h / g)``; twice that time is looked at.
    """
    span = CLEAR * tracked.radius
    time = 4.0 * np.sqrt(2.0 * span / np.linalg.norm(tracked.structure.file.gravity))
    end = tracked.heights(test)[test.time > test.time[-1] - time]
    return float(end.min()) if test.time[-1] > time and np.ptp(end, axis=0).max() < span else 0.0
