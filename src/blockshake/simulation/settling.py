"""Bodies that move before the ground does: their contacts do not hold them where the structure file puts them."""

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import PITCH
from blockshake.geometry.rotations import rotation_matrices

_STRONG = 0.02  # of gravity: what is weaker moves no body that stands
_PITCHED = 0.002  # rad: a fifth of the least move, which a body that follows makes too
_LEAST = 0.01  # of a body's largest extent, by which one of its vertices moves


def quiet_until(structure, motion):
    """Time until which the ground is nearly at rest [s]; zero if it always is.

    Its acceleration, 1 m from the axis of a pitch, is below 2 % of gravity, and it has pitched by less than 0.002 rad.
    """
    breaks = motion.table.breaks
    strength = np.linalg.norm(motion.evaluate(breaks, 2), axis=1)
    pitch = motion.evaluate(breaks)[:, PITCH]
    moves = strength > _STRONG * np.linalg.norm(structure.file.gravity)
    moves |= np.abs(pitch - pitch[0]) > _PITCHED
    return max(float(breaks[max(np.argmax(moves) - 1, 0)]), 0.0)


def settling(structure, position, orientation):
    """Words on the body that has moved most while the ground was at rest; empty where none has by 1 % of its size.

    ``position`` (n_bodies, 3) and ``orientation`` (n_bodies, 4): at the end of the rest [m], unit quaternions. The move
    is that of the farthest vertex from where the structure file puts it, seen from the first driven body. Bodies that
    touch nothing, or are given a velocity, are left out. A block that is let go tilted moves too, and is reported.
    """
    watched, _ = collapse_limits(structure)
    watched &= ~structure.velocity.any(axis=1) & ~structure.angular_velocity.any(axis=1)
    base, worst, words = int(np.argmax(structure.driven)), _LEAST, ""
    before, now = rotation_matrices(structure.orientation), rotation_matrices(orientation)
    carried = now[base] @ before[base].T
    place = position[base] + (structure.position - structure.position[base]) @ carried.T
    before = carried @ before
    for body in np.flatnonzero(watched):
        vertices = structure.solid(body).vertices
        moved = position[body] - place[body] + vertices @ (now[body] - before[body]).T
        share = np.linalg.norm(moved, axis=1).max() / np.ptp(vertices, axis=0).max()
        if share > worst:
            tilt = np.degrees(np.arccos(np.clip(now[body, 2] @ before[body, 2], -1.0, 1.0)))
            worst = share
            words = (
                f"{structure.body_names[body]} moved by {share:.1%} of its size and tilted by {tilt:.2g} degrees "
                "before the ground moved: its contacts do not hold it as it was placed"
            )
    return words
