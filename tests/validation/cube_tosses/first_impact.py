"""Restitution and friction read off the first impact of a toss, without any simulation."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation
from scores import impacts
from tosses import CORNERS, GRAVITY

SPAN = 3  # intervals over which a velocity is read: 20 ms
SHARP = 0.25  # half-widths between the lowest corner and the next: more is a corner alone, tilted by 7 degrees and more


class FirstImpact(NamedTuple):
    """Velocity after over before of the lowest corner, along the normal; tangential over normal impulse; which contact.

    The impulses are those on the centre, as if the mass centre were there.
    """

    restitution: float
    impulse_ratio: float
    corner: bool


def first_impact(toss):
    """First impact of a toss, or None where a second follows within 40 ms or too little flight precedes."""
    hits = impacts(toss)
    if hits[0] <= SPAN + 1 or (len(hits) > 1 and hits[1] - hits[0] < SPAN + 3):
        return None
    hit, step = hits[0], toss.time[1]
    arms = toss.rotation[hit] @ CORNERS.T * toss.half_width
    heights = np.sort(arms[2])
    arm = arms[:, np.argmin(arms[2])]
    before, after = (_velocities(toss, first, hit, step) for first in (hit - 1 - SPAN, hit + 1))
    falling, rising = (velocity + np.cross(spin, arm) for velocity, spin in (before, after))
    kick = after[0] - before[0]
    return FirstImpact(
        restitution=float(-rising[2] / falling[2]),
        impulse_ratio=float(np.hypot(kick[0], kick[1]) / kick[2]),
        corner=bool(heights[1] - heights[0] > SHARP * toss.half_width),
    )


def _velocities(toss, first, hit, step):
    """Velocity at the impact, by free fall, and angular velocity, from `SPAN` intervals after the reading ``first``."""
    last, span = first + SPAN, SPAN * step
    velocity = (toss.position[last] - toss.position[first]) / span
    velocity[2] -= GRAVITY * (hit - 0.5 * (first + last)) * step
    turned = Rotation.from_matrix(toss.rotation[[first, last]])
    return velocity, (turned[1] * turned[0].inv()).as_rotvec() / span
