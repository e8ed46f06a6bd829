"""Rows of every test beside what its turned and slipping faces put into them, each made once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from blockshake.forces.seen.seen_test import SeenTest
from blockshake.forces.seen.wrench_histories import (
    edge_inward,
    edges_along,
    friction_against_slip,
    mass_centre_off,
    normal_force,
)


@dataclass(frozen=True)
class Hinge:
    """A face that turns about an edge, which lies off its middle along one of its tangents.

    Attributes
    ----------
    inward, along : float64 arrays, shape (n_rows,)
        In the rows: edges 1 m further in, and edges 1 m further along the tangent [N m/m].
    edge : int8 array, shape (n_rows,)
        Edge that bears.
    turn, normal : float64 arrays, shape (n_rows,)
        Rotation without its sign [rad], and normal force [N].
    """

    inward: np.ndarray
    along: np.ndarray
    edge: np.ndarray
    turn: np.ndarray
    normal: np.ndarray


@dataclass(frozen=True)
class Slide:
    """A face that slips.

    Attributes
    ----------
    friction : float64 array, shape (n_rows,)
        In the rows: a coefficient of friction of 1 against the slip [N, N m].
    rate : float64 array, shape (n_rows,)
        Slip rate without its sign [m/s].
    """

    friction: np.ndarray
    rate: np.ndarray


@dataclass(frozen=True)
class JointRows:
    """Rows of one test, and its hinges and slides."""

    seen: SeenTest

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
                    found[face, tangent] = Hinge(
                        inward,
                        self.rows.along(edges_along(self.seen, face, tangent)),
                        self.seen.states.edge[instant, face, tangent],
                        np.abs(turn[instant, face]),
                        np.abs(normal_force(self.seen, face)[instant]),
                    )
        return found

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
