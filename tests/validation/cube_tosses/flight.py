"""Figures of free flight: the state at the start, gravity, the mass centre and the noise of the poses."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation
from tosses import GRAVITY, rest_heights

RATE = 148.0  # Hz
LEAST_FLIGHT = 4  # readings, enough for a line in each coordinate and something left to judge it by


@dataclass(frozen=True)
class InitialState:
    """State at a toss's first reading.

    ``position`` [m] and ``velocity`` [m/s] of the mass centre, ``orientation`` (w, x, y, z) and ``angular_velocity``
    [rad/s], world frame; ``position_residual`` [m] and ``rotation_residual`` [rad], shape (n_flight, 3), what the
    fit leaves.
    """

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    position_residual: np.ndarray
    rotation_residual: np.ndarray

    def perturbed(self, noise, bias, random):
        """Another start that the measurement allows.

        The pose is off by a common ``bias`` (m, rad) of all readings, the velocities by what independent ``noise``
        (m, rad) of each reading leaves in the slope of a line through the flight; standard deviations of a component.
        """
        n = len(self.position_residual)
        per_second = RATE / np.sqrt(n * (n * n - 1.0) / 12.0)  # of a line's slope, for unit noise
        sizes = bias[0], noise[0] * per_second, bias[1], noise[1] * per_second
        drawn = random.standard_normal((4, 3)) * np.array(sizes)[:, None]
        turned = Rotation.from_rotvec(drawn[2]) * Rotation.from_quat(self.orientation, scalar_first=True)
        return replace(
            self,
            position=self.position + drawn[0],
            velocity=self.velocity + drawn[1],
            orientation=turned.as_quat(scalar_first=True),
            angular_velocity=self.angular_velocity + drawn[3],
        )


def initial_state(toss, mass_centre=(0.0, 0.0, 0.0)):
    """State at the first reading, by least squares over the free flight.

    The mass centre, at ``mass_centre`` [m] in the body frame, falls with g; an isotropic inertia keeps the
    angular velocity constant. Lines through positions less the parabola of g, and through rotation
    vectors about the middle pose.
    """
    n = toss.flight
    if n < LEAST_FLIGHT:
        raise ValueError(f"{toss.name} has {n} readings of free flight; expected at least {LEAST_FLIGHT}")
    time = toss.time[:n]
    centre = toss.position[:n] + toss.rotation[:n] @ np.asarray(mass_centre)
    centre[:, 2] += 0.5 * GRAVITY * time**2
    turned = Rotation.from_quat(toss.orientation[:n], scalar_first=True)
    middle = turned[n // 2]
    vectors = (turned * middle.inv()).as_rotvec()
    matrix = np.column_stack([np.ones(n), time])
    (position, velocity), *_ = np.linalg.lstsq(matrix, centre, rcond=None)
    (offset, angular_velocity), *_ = np.linalg.lstsq(matrix, vectors, rcond=None)
    orientation = (Rotation.from_rotvec(offset) * middle).as_quat(scalar_first=True)
    return InitialState(
        position=position,
        orientation=orientation,
        velocity=velocity,
        angular_velocity=angular_velocity,
        position_residual=centre - matrix @ [position, velocity],
        rotation_residual=vectors - matrix @ [offset, angular_velocity],
    )


def flight_noise(tosses, mass_centre=(0.0, 0.0, 0.0)):
    """Standard deviation of a component of position [m] and of rotation [rad] about free flight."""
    squares, freedoms = np.zeros(2), 0
    for toss in tosses:
        start = initial_state(toss, mass_centre)
        squares += [np.sum(start.position_residual**2), np.sum(start.rotation_residual**2)]
        freedoms += 3 * (toss.flight - 2)
    return np.sqrt(squares / freedoms)


def rest_bias(tosses):
    """Shared error of poses at rest: of the height [m] and of the tilt about a level axis [rad].

    Standard deviation of the heights, and the rms component of the angle between the face's normal and the vertical.
    """
    upward = np.array([np.abs(toss.rotation[-5:, 2]).mean(axis=0) for toss in tosses])
    tilts = np.arccos(np.minimum(upward.max(axis=1), 1.0))
    return np.array([rest_heights(tosses).std(), np.sqrt(np.mean(tilts**2) / 2.0)])


@dataclass(frozen=True)
class Fall:
    """Fit of all flights together.

    ``gravity`` [m/s2] and ``mass_centre`` in the body frame [m]; ``errors``, the standard deviations of these six
    numbers for independent readings; ``residual``, that of a coordinate [m].
    """

    gravity: np.ndarray
    mass_centre: np.ndarray
    errors: np.ndarray
    residual: float


def common_fall(tosses, least=12):
    """Gravity and mass centre that all flights share, by least squares.

    The tracked point is ``p = c + v t + g t^2 / 2 - R d`` for the mass centre d in the body frame: c and v are each
    toss's own, g and d common. Only flights of ``least`` readings or more count.
    """
    normal, right, squares, count = np.zeros((6, 6)), np.zeros(6), 0.0, -6
    for toss in tosses:
        n = toss.flight
        if n < least:
            continue
        own, _ = np.linalg.qr(np.column_stack([np.ones(n), toss.time[:n]]))
        design = np.zeros((n, 3, 6))
        design[:, [0, 1, 2], [0, 1, 2]] = 0.5 * toss.time[:n, None] ** 2
        design[:, :, 3:] = -toss.rotation[:n]
        design = _without(own, design.reshape(n, -1)).reshape(-1, 6)
        values = _without(own, toss.position[:n]).ravel()
        normal += design.T @ design
        right += design.T @ values
        squares += values @ values
        count += 3 * (n - 2)
    common = np.linalg.solve(normal, right)
    residual = np.sqrt((squares - right @ common) / count)
    errors = residual * np.sqrt(np.diag(np.linalg.inv(normal)))
    return Fall(common[:3], common[3:], errors, float(residual))


def length_scale(tosses):
    """Lengths of the file over true ones, by two witnesses: the height at rest, and gravity."""
    height = np.median(rest_heights(tosses)) / tosses[0].half_width
    return float(height), float(-common_fall(tosses).gravity[2] / GRAVITY)


def _without(own, values):
    return values - own @ (own.T @ values)
