"""Reader of the measured cube tosses: a test of its own kind, with a start and a path but no motion of the ground."""

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from blockshake.geometry.rotations import rotation_matrices

GRAVITY = 9.81  # m/s2; the file's own, in half-widths, is this over the half-width
# m, the lowest corner of a cube in free flight; farther than the tracked corners sink in (docs/results/tosses.md)
CLEAR = 2e-3
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)


@dataclass(frozen=True)
class Toss:
    """One measured toss onto a table whose top is z = 0.

    Attributes
    ----------
    name : str
        As in the file.
    time : float64 array, shape (n_times,)
        Since the first reading, uniform [s].
    position : float64 array, shape (n_times, 3)
        Of the cube's centre, world frame, z up [m].
    orientation : float64 array, shape (n_times, 4)
        Unit quaternions (w, x, y, z), body to world.
    half_width : float
        Of the cube [m].
    """

    name: str
    time: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    half_width: float

    @cached_property
    def rotation(self):
        """Rotation matrices, body to world, shape (n_times, 3, 3)."""
        return rotation_matrices(self.orientation)

    @cached_property
    def lowest_corner(self):
        """Height of the lowest corner of a sharp cube at each reading [m]."""
        return self.position[:, 2] + self.half_width * (self.rotation[:, 2] @ CORNERS.T).min(axis=1)

    @cached_property
    def flight(self):
        """Readings before the cube comes near the table the first time."""
        return int(np.argmax(self.lowest_corner < CLEAR))


@dataclass(frozen=True)
class Experiment:
    """All tosses with what their file says of them.

    ``half_width`` of the cube [m], its ``mass`` [kg] and moment of ``inertia`` about any axis through
    the centre [kg m2]; the authors' ``friction`` and ``restitution`` [1]; ``scale`` of the lengths, true = file
    over scale.
    """

    tosses: tuple
    half_width: float
    mass: float
    inertia: float
    friction: float
    restitution: float
    scale: float

    def sample(self, names):
        """Tosses of these names, in file order."""
        return [toss for toss in self.tosses if toss.name in set(names)]


def tosses_folder():
    """Folder of the tosses, which is not part of the project; it may be absent."""
    shared = os.environ.get("BLOCKSHAKE_SHARED") or Path(__file__).parents[3].parent / "shared"
    return Path(shared) / "measured" / "cube-tosses"


def read_tosses(folder, scale=1.0):
    """Every toss of a folder, in SI.

    Parameters
    ----------
    folder : path
        With ``cube_tosses.npz`` (an array a toss: position 3, quaternion w, x, y, z, velocity 3,
        angular velocity 3, control 6; lengths in half-widths) and ``experiment.json``.
    scale : float
        The file's lengths are this many times the true ones [1]; see `length_scale`.

    Notes
    -----
    The recorded velocities are backward differences through a median filter, the angular ones in body axes. They
    are not read: `flight.initial_state` takes the velocities from the poses.
    """
    about = json.loads((folder / "experiment.json").read_text())
    half_width = GRAVITY / about["g"]
    tosses = []
    with np.load(folder / "cube_tosses.npz") as file:
        for name in sorted(file):
            rows = file[name].astype(float)
            quaternion = rows[:, 3:7] / np.linalg.norm(rows[:, 3:7], axis=1, keepdims=True)
            sign = np.where(np.einsum("ij,ij->i", quaternion[1:], quaternion[:-1]) < 0.0, -1.0, 1.0)
            quaternion[1:] *= np.cumprod(sign)[:, None]
            time = np.arange(len(rows)) * about["dt"]
            tosses.append(Toss(name, time, rows[:, :3] * half_width / scale, quaternion, half_width))
    return Experiment(
        tosses=tuple(tosses),
        half_width=half_width,
        mass=about["mass"],
        inertia=about["inertia"] * half_width**2,
        friction=about["mu"],
        restitution=about["restitution"],
        scale=scale,
    )


def rest_heights(tosses):
    """Height of the centre over the last five readings of each toss [m]."""
    return np.array([toss.position[-5:, 2].mean() for toss in tosses])


def halves(tosses, seed):
    """Names of the tosses to fit and of those to predict: half and half, drawn by ``seed``."""
    names = [toss.name for toss in tosses]
    order = np.random.default_rng(seed).permutation(len(names))
    middle = len(names) // 2
    return [names[place] for place in order[:middle]], [names[place] for place in order[middle:]]
