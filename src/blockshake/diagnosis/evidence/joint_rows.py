"""Rows of every test next to what its turned and slipping faces put into them, each made once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from blockshake.forces.joint_motion import TURNED
from blockshake.forces.seen.reconstructed_test import ReconstructedTest
from blockshake.forces.seen.wrench_histories import (
    bed_inset,
    edge_inward,
    edges_along,
    friction_against_slip,
    heavier,
    mass_centre_off,
    normal_force,
)
from blockshake.geometry.rotations import rotation_matrices


@dataclass(frozen=True)
class Hinge:
    """A face that turns about an edge, which lies off its middle along one of its tangents."""

    # inward, along: float64 (n_rows,); in the rows: edges 1 m further in, and edges 1 m further along the
    # tangent [N m/m]
    inward: np.ndarray
    along: np.ndarray
    edge: np.ndarray  # int8 (n_rows,); edge that bears
    # turn, normal: float64 (n_rows,); rotation without its sign [rad], and normal force [N]
    turn: np.ndarray
    normal: np.ndarray
    # float64 (n_rows,); `bed_inset` of faces as soft as the two blocks, at the least rotation that counts as
    # turned [m]
    bed: np.ndarray


@dataclass(frozen=True)
class Slide:
    """A face that slips."""

    # float64 (n_rows,); in the rows: a coefficient of friction of 1 against the slip [N, N m]
    friction: np.ndarray
    rate: np.ndarray  # float64 (n_rows,); slip rate without its sign [m/s]


@dataclass(frozen=True)
class JointRows:
    """Rows of one test, and its hinges and slides."""

    seen: ReconstructedTest

    @property
    def rows(self):
        """`EquilibriumRows` of the test."""
        return self.seen.rows

    @cached_property
    def hinges(self):
        """`Hinge` by face and tangent, of those that turn in any row."""
        found = {}
        joints, instant = self.seen.joints, self.rows.instant
        for face in range(len(self.seen.faces)):
            for tangent, turn in enumerate((joints.rotation, joints.roll)):
                inward = self.rows.along(edge_inward(self.seen, face, tangent))
                if inward.any():
                    normal = np.abs(normal_force(self.seen, face)[instant])
                    found[face, tangent] = Hinge(
                        inward,
                        self.rows.along(edges_along(self.seen, face, tangent)),
                        self.seen.states.edge[instant, face, tangent],
                        np.abs(turn[instant, face]),
                        normal,
                        bed_inset(normal, self._softness(face), TURNED, self.seen.faces[face], tangent),
                    )
        return found

    def _softness(self, face):
        """Closure of the halves of both blocks of a face by pressure, ``h / 2 E`` each [m3/N]."""
        structure, soft = self.seen.structure, 0.0
        for body in (self.seen.faces[face].lower, self.seen.faces[face].upper):
            along = rotation_matrices(structure.orientation[body]).T @ self.seen.faces[face].axes[:, 2]
            modulus = structure.file.materials[structure.file.bodies[body].material].youngs_modulus
            soft += 0.5 * float(np.ptp(structure.solid(body).vertices @ along)) / modulus
        return soft

    @cached_property
    def slides(self):
        """`Slide` by face, of those that slip in any row."""
        found = {}
        for face in range(len(self.seen.faces)):
            friction = self.rows.along(friction_against_slip(self.seen, face))
            if friction.any():
                rate = np.abs(self.seen.joints.slip_rate[self.rows.instant, face])
                found[face] = Slide(friction, rate)
        return found

    @cached_property
    def eccentric(self):
        """Rows of a mass centre 1 m off along x, by free body."""
        return {int(body): self.rows.along(mass_centre_off(self.seen, body)) for body in self.seen.free}

    @cached_property
    def heavier(self):
        """Rows of twice the mass at the mass centre, by free body."""
        return {int(body): self.rows.along(heavier(self.seen, body)) for body in self.seen.free}
