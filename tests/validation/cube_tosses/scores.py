"""How far a replay is from its toss: along the path, by contact, and at rest."""

from dataclasses import dataclass

import numpy as np
from tosses import GRAVITY

KICK = 0.2  # m/s upward within a reading, above what weight, noise and rocking give: three times g over a reading


@dataclass(frozen=True)
class Score:
    """Errors at each reading: ``position`` of the middle [m], ``rotation`` [rad], rms over the ``corners`` [m]."""

    position: np.ndarray
    rotation: np.ndarray
    corners: np.ndarray


def score(toss, replay):
    """Errors of a replay."""
    return difference(toss.position, toss.rotation, replay.position, replay.rotation, toss.half_width)


def difference(position, rotation, other_position, other_rotation, half_width):
    """Errors between two paths.

    The rms distance of the eight corners follows from both: ``|dp|^2 + 2 h^2 (3 - tr R^T R')``, as the corners' second
    moment is ``h^2`` times the unit matrix.
    """
    apart = np.linalg.norm(position - other_position, axis=1)
    trace = np.einsum("tij,tij->t", rotation, other_rotation)
    turned = np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0))
    return Score(apart, turned, np.sqrt(apart**2 + 2.0 * half_width**2 * np.maximum(3.0 - trace, 0.0)))


def impacts(toss):
    """Readings at which the centre is kicked up by more than `KICK`: the measured impacts, first reading of each."""
    time = toss.time
    step = time[1] - time[0]
    height = toss.position[:, 2]
    kick = (height[2:] - 2.0 * height[1:-1] + height[:-2]) / step + GRAVITY * step
    hit = np.flatnonzero(kick > KICK) + 1
    return hit[np.diff(hit, prepend=-9) > 2]


def horizons(toss):
    """Readings to compare at: the last before the second, third and fourth impact, and the last of all."""
    hits = impacts(toss)
    found = {
        f"before impact {number}": int(hits[number - 1]) - 1 for number in (2, 3, 4) if len(hits) >= number
    }
    return {**found, "at rest": len(toss.time) - 1}


def quantiles(values):
    """Quarter, half, three quarters and 90 % of the values."""
    return np.quantile(np.asarray(values), [0.25, 0.5, 0.75, 0.9])
