"""Pounding of blocks that stand apart, such as two leaves of a wall: how often their gap closes, and how fast."""

import numpy as np

from blockshake.dynamics.collapse import COSINE_OF_TILT
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import contact_normals

_CLOSED = 1e-4  # m
_SLOWEST = 0.05  # m/s: what is slower leans and does not strike


def pounding(run, structure):
    """Blows of a run between blocks that stood apart next to each other at the start: how many, the velocity of the
    fastest [m/s], and its two blocks; 0 and an empty text without any.

    Notes
    -----
    The gap of two convex bodies is given by the two faces that look at each other at the start, each of which turns
    with its body: the larger distance of the other body's nearest corner. A blow is where the gap closes to 0.1 mm, or
    would by its velocity, between two rows of the run, and opens before it closes again; its velocity is the larger one
    of the two steps between rows before it, the last of which may hold a part of the blow. Slower ones than 0.05 m/s
    are left out. Neither a force nor an impulse is reported: a run holds forces at its rows alone, and a blow is over
    before the next one.
    """
    names = structure.body_names
    pairs = np.array([[names.index(name) for name in run[side].values] for side in ("lower", "upper")], int).T
    apart = ~structure.touching[tuple(pairs.T)] & ~structure.driven[pairs].any(axis=1)
    seen = run.isel(time=run["position"].notnull().all(("body", "axis")).to_numpy())
    seen = seen.transpose("time", "body", "axis", "quaternion", ...)
    motion = seen["position"].to_numpy(), rotation_matrices(seen["orientation"].to_numpy())
    blows, velocity, pair = 0, 0.0, ""
    for (a, b), normal in zip(pairs[apart], contact_normals(structure, pairs[apart]), strict=True):
        gap = _gap(structure, *motion, a, b, normal)
        if gap is None:
            continue
        found = blow_velocities(gap, np.diff(seen["time"].to_numpy()))
        blows += len(found)
        if max(found, default=0.0) > velocity:
            velocity, pair = float(max(found)), f"{names[a]} and {names[b]}"
    return blows, velocity, pair


def gap_of_pair(structure, position, turns, a, b):
    """Gap over time of two bodies that stand next to each other at the start, (n_times,) [m]; None of others.

    ``position`` and ``turns``: (n_times, n_bodies, 3) [m] and (n_times, n_bodies, 3, 3), body to world.
    """
    (normal,) = contact_normals(structure, np.array([[a, b]]))
    return _gap(structure, position, turns, a, b, normal)


def _gap(structure, position, turns, a, b, normal):
    up = np.array(structure.file.gravity)
    if not abs(normal @ up) < COSINE_OF_TILT * np.linalg.norm(up):  # above each other, or not convex
        return None
    sides = (a, b, normal), (b, a, -normal)
    return np.maximum(*(_distances(structure, position, turns, *side) for side in sides))


def _distances(structure, position, turns, body, other, normal):
    """Distance of the nearest corner of another body from a face of a body over time [m]; ``normal`` at the start."""
    outward = rotation_matrices(structure.orientation[body]).T @ normal
    corners = np.einsum("tij,vj->tvi", turns[:, other], structure.solid(other).vertices)
    corners += (position[:, other] - position[:, body])[:, None]
    nearest = np.einsum("tvi,ti->tv", corners, turns[:, body] @ outward).min(axis=1)
    return nearest - (structure.solid(body).vertices @ outward).max()


def blow_velocities(gap, step):
    """Velocities of the blows of a gap over time [m/s]; ``step`` (n_times - 1,) [s]."""
    closing = -np.diff(gap)[:-1] / step[:-1]  # up to every row but the first and the last
    now, following = gap[1:-1], gap[2:]
    hits = (
        (now > _CLOSED) & (np.minimum(now - closing * step[1:], following) <= _CLOSED) & (closing > _SLOWEST)
    )
    return np.maximum(closing, np.append(0.0, closing[:-1]))[hits & ~np.append(False, hits[:-1])]
