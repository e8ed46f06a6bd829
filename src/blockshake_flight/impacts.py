"""Impacts on a level ground as the motion before and after shows them: restitution, impulse, and spin kept."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake_flight.tumbling import spins, tumbling

_TOGETHER = 0.05  # of the radius, within which the lowest vertices hit together
_KINDS = {1: "corner", 2: "edge"}  # by vertices that hit together; more are a face
_APART = 8.5  # readings between two flights, in which only one impact lies
_OF_ONE = 0.7  # cosine between the change of spin and the moment of the impulse, below which several points were hit
_SEEN = 0.1  # m/s of approach, below which a share of it is unknown
_FLAT = 0.05  # rad off the flat pose, within which a face comes down
_ON = 0.1  # of the radius, within which a body that comes down on a face has stayed on the ground before
_TURNING = 0.5  # rad/s of approach, below which spin kept is unknown
_WINDOW = 5  # readings of each side, of a face that comes down without a flight


class FlightImpact(NamedTuple):
    """One impact.

    ``test``, ``time`` [s]; ``kind``: corner, edge or face; ``restitution``: normal velocity of the contact after over
    before, reversed [1]; ``ratio``: tangential over normal impulse [1]; NaN of a face that comes down without a
    flight. ``kept``: spin after over before, along the spin before: negative where the body returns to the edge that
    it came from [1], about level axes of a face without a flight.
    """

    test: str
    time: float
    kind: str
    restitution: float
    ratio: float
    kept: float


def find_impacts(tracked, arcs):
    """All `FlightImpact` of a campaign that lie between two flights, and all faces that come down in rocking."""
    found = []
    for test in tracked.tests:
        own = [arc for arc in arcs if arc.test == test.name]
        for before, after in pairwise(own):
            impact = _between(tracked, test, before, after)
            if impact:
                found.append(impact)
        found += _rocking(tracked, test)
    return found


def _between(tracked, test, before, after):
    """The impact between two flights; None where there may be several, or none."""
    step = float(np.median(np.diff(test.time)))
    start, end = test.time[before.last], test.time[after.first]
    if end - start > _APART * step:
        return None
    times = np.linspace(start, end, 50)
    offset = np.array(tracked.structure.file.bodies[tracked.body].mass_offset)
    arms = tracked.vertices - offset
    down = [_moved(tracked, arc, offset, times - test.time[arc.first]) for arc in (before, after)]
    heights = [(p[:, 2, None] + R[:, 2] @ arms.T - tracked.ground).min(axis=1) for p, _, R, _ in down]
    at = int(np.argmin(np.abs(heights[0] - heights[1])))
    (place, came, turned, spin), (_, left, _, spun) = ([one[at] for one in side] for side in down)
    height = place[2] + turned[2] @ arms.T
    hit = height < height.min() + _TOGETHER * tracked.radius
    arm = turned @ arms[hit].mean(axis=0)
    inertia = (
        turned @ tracked.structure.inertia[tracked.body] @ turned.T / tracked.structure.mass[tracked.body]
    )
    restitution, ratio = impact_law(came, left, spin, spun, arm, inertia)
    if np.isnan(restitution):
        return None
    return FlightImpact(
        test.name, float(times[at]), _KINDS.get(int(hit.sum()), "face"), restitution, ratio, _kept(spin, spun)
    )


def impact_law(came, left, spin, spun, arm, inertia):
    """Restitution and ratio of impulses of one impact on a level ground, by momentum balance.

    Parameters
    ----------
    came, left, spin, spun : float64 arrays, shape (3,)
        Velocity of the mass centre [m/s] and angular velocity [rad/s], before and after, z up.
    arm : float64 array, shape (3,)
        The contact from the mass centre [m].
    inertia : float64 array, shape (3, 3)
        Over the mass, about the mass centre, world frame [m2].

    Returns
    -------
    restitution, ratio : float
        Restitution of the normal velocity of the contact; tangential over normal impulse [1]. NaN where the contact
        did not come down, or where the spin does not change as an impulse at the contact would change it.
    """
    approach, impulse = (came + np.cross(spin, arm))[2], left - came
    fits = _cosine(inertia @ (spun - spin), np.cross(arm, impulse)) >= _OF_ONE
    if approach > -_SEEN or impulse[2] <= 0.0 or not fits:
        return np.nan, np.nan
    restitution = -(left + np.cross(spun, arm))[2] / approach
    return float(restitution), float(np.linalg.norm(impulse[:2]) / impulse[2])


def _cosine(one, other):
    size = np.linalg.norm(one) * np.linalg.norm(other)
    return one @ other / size if size > 0.0 else 1.0


def _kept(before, after):
    return float(before @ after / (before @ before)) if np.linalg.norm(before) > _TURNING else np.nan


def _moved(tracked, arc, offset, time):
    """Place and velocity of the mass centre, rotation and spin of a flight at some times near one of its ends."""
    fit = np.polynomial.Polynomial
    centre = arc.position + arc.rotation @ offset
    paths = [fit.fit(arc.time, centre[:, axis], 2) for axis in range(3)]
    path, momentum = tumbling(tracked, arc)
    end = 0 if time[-1] <= arc.time[0] else -1
    spin = spins(tracked, path, momentum)[end]
    rotation = (Rotation.from_rotvec((time - arc.time[end])[:, None] * spin) * path[end]).as_matrix()
    place = np.array([one(time) for one in paths]).T
    velocity = np.array([one.deriv()(time) for one in paths]).T
    return place, velocity, rotation, np.broadcast_to(spin, place.shape)


def _rocking(tracked, test):
    """Faces that come down while the body stays on the ground, returns to the same edge among them."""
    heights = tracked.heights(test).min(axis=1)
    solid = tracked.structure.solids[tracked.structure.file.bodies[tracked.body].shape]
    down = -test.rotation[:, 2] @ solid.polyhedron.normals.T
    face = np.nan_to_num(down, nan=-1.0).argmax(axis=1)
    tilt = np.arccos(np.clip(np.nan_to_num(down, nan=-1.0).max(axis=1), -1.0, 1.0))
    low = np.nan_to_num(heights, nan=np.inf) < _ON * tracked.radius
    for at in range(_WINDOW + 1, len(tilt) - _WINDOW - 1):
        around = slice(at - _WINDOW, at + _WINDOW + 1)
        if tilt[at] > _FLAT or tilt[at] > tilt[around].min() or not low[at - _WINDOW : at + 1].all():
            continue
        if not (face[around] == face[at]).all() or np.isnan(heights[around]).any():
            continue
        before, after = (
            _spin(test.time[rows], test.rotation[rows])
            for rows in (slice(at - _WINDOW, at), slice(at + 1, at + _WINDOW + 1))
        )
        if tilt[at - _WINDOW] > 2.0 * tilt[at] and np.linalg.norm(before) > _TURNING:
            yield FlightImpact(test.name, float(test.time[at]), "face", np.nan, np.nan, _kept(before, after))


def _spin(time, rotation):  # about level axes: a body that lies on its face and turns does not come down
    turned = Rotation.from_matrix(rotation)
    line = np.stack([np.ones_like(time), time - time.mean()], axis=1)
    return np.linalg.lstsq(line, (turned * turned[len(time) // 2].inv()).as_rotvec()[:, :2], rcond=None)[0][1]


def summary(impacts):
    """Restitution, ratio of impulses and spin kept by kind: quartiles with counts, and returns to the same edge.

    Returns
    -------
    dict of str to dict
        By kind and quantity: ``count``, ``lower``, ``median``, ``upper``; and ``returned``, the share of faces without
        a flight whose spin is reversed, with its ``count``.
    """
    found = {}
    for kind in ("corner", "edge", "face"):
        own = [impact for impact in impacts if impact.kind == kind]
        for name in ("restitution", "ratio", "kept"):
            values = np.array([getattr(impact, name) for impact in own])
            values = values[np.isfinite(values)]
            if len(values):
                lower, median, upper = np.quantile(values, (0.25, 0.5, 0.75))
                found.setdefault(kind, {})[name] = {
                    "count": len(values), "lower": float(lower), "median": float(median), "upper": float(upper),
                }  # fmt: skip
    rocked = [impact.kept for impact in impacts if impact.kind == "face" and np.isnan(impact.restitution)]
    if rocked:
        found["face"]["returned"] = {"count": len(rocked), "share": float(np.mean(np.array(rocked) < 0.0))}
    return found
