"""Impacts of a seen test: the spin of all that stands on a joint before and after the joint has closed."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.sparse.csgraph import connected_components

_NEAREST, _FARTHEST = 3.0, 9.0  # widths of the kernel from an impact: nearer a rate feels it
_FEWEST = 4  # instants on either side
_CLOSED = 0.08  # s: a joint that stays closed for longer has come to rest
_SAME = 0.01  # s: the closing and the opening are one impact
_LEAST_SPIN = 0.02  # rad/s: slower closings are elastic
_BEARS, _EDGE_ERROR = 10, 0.005  # instants by which a bearing edge is known; m


@dataclass(frozen=True)
class Impact:
    """One closing of a joint between a driven body and all that it alone carries."""

    time: float  # [s]
    returned: bool  # the joint opens again to the edge from which it came
    blocks: int  # number of bodies above the joint
    # of these bodies as the joint closes: their angular momentum about the edge that bears, over their moment
    # of inertia about it, positive towards the closing [rad/s]
    spin: float
    # spin afterwards, about the edge that bears then, over that before; negative where the joint returns [1]
    kept: float
    error: float  # standard deviation of ``kept``, by the sensors and by where the edges bear [1]
    # ``kept`` if the bodies turn as one and are struck at the other edge alone (Housner 1963) [1]
    plastic: float


def find_impacts(seen):
    """`Impact` of a `ReconstructedTest`, a list by joint and time.

    A joint is left out where the bodies above stand on another joint too: its impulse is not known.

    Notes
    -----
    In the frame of the table, the moment of ``m (g - a_table)`` alone changes the angular momentum of the bodies above
    about the edge that bears, whatever happens in the joints between them. The momentum is read on either side of the
    impact, beyond the reach of the kernel, and carried to the instant of the impact by that moment, which the
    positions give. About the other edge a plastic impact keeps the momentum, bounces at that edge or not.
    """
    impacts = []
    for face in range(len(seen.faces)):
        above = _carried_alone(seen, face)
        if len(above):
            pairs = _closings(seen.joints.side[:, face], np.abs(seen.joints.rotation[:, face]))
            impacts += [_impact(seen, face, above, *pair) for pair in pairs]
    return [impact for impact in impacts if impact is not None]


def _carried_alone(seen, face):
    """Free bodies that stand on the driven ones by one face and by no other; empty if there are none."""
    driven, links = seen.structure.driven, np.zeros((len(seen.structure.mass),) * 2, dtype=bool)
    for joint in seen.faces:
        links[joint.lower, joint.upper] = not (driven[joint.lower] or driven[joint.upper])
    _, group = connected_components(links, directed=False)
    above = (group == group[seen.faces[face].upper]) & ~driven
    feet = [joint.name for joint in seen.faces if driven[joint.lower] and above[joint.upper]]
    return np.flatnonzero(above) if feet == [seen.faces[face].name] else np.zeros(0, int)


def _closings(side, turn):
    """Last instant turned before and first instant turned after every closing, seen or passed between two instants."""
    turned = np.flatnonzero(side)
    lowest = np.flatnonzero((turn[1:-1] < turn[:-2]) & (turn[1:-1] <= turn[2:])) + 1
    kinks = {
        (low - 1, low + 1) for low in lowest if side[low] and side[low - 1] == side[low] == side[low + 1]
    }
    closed = {(a, b) for a, b in pairwise(turned) if b > a + 1 or side[a] != side[b]}
    return sorted(kinks | closed)


def _impact(seen, face, above, last, first):
    """`Impact` between two instants; None where it tells nothing."""
    time, side = seen.motion.time, seen.joints.side[:, face]
    windows = [_window(seen, side, near, 0.5 * (time[last] + time[first])) for near in (last, first)]
    if time[first] - time[last] > _CLOSED or min(map(len, windows)) < _FEWEST:
        return None
    closes, opens = (_closes(seen, face, near) for near in (windows[0][-1], windows[1][0]))
    at = 0.5 * (closes + opens)
    if not (time[last] <= at <= time[first] and abs(opens - closes) < _SAME):
        return None
    bodies = _Bodies(seen, seen.faces[face].lower, above, int(np.argmin(np.abs(time - at))), float(at))
    old, new = (bodies.line(face, edge) for edge in (side[last], -side[last]))
    returned = bool(side[first] == side[last])
    later = old if returned else new
    (before, error), (after, error_after) = (
        bodies.momentum(line, window) / bodies.inertia(line, line)
        for line, window in zip((old, later), windows, strict=True)
    )
    if not -side[last] * before > _LEAST_SPIN or not np.isfinite([after, error, error_after]).all():
        return None
    kept = after / before
    error = float(np.hypot(error_after, kept * error) / abs(before))
    plastic = bodies.inertia(old, new) / bodies.inertia(new, new)
    return Impact(bodies.at, returned, len(above), float(abs(before)), float(kept), error, plastic)


def _window(seen, side, near, at):
    """Instants on the side of an impact on which ``near`` lies, beyond the kernel's reach, while the edge bears."""
    time = seen.motion.time
    away = (time - at) * np.sign(time[near] - at) / seen.motion.width
    other = (side != side[near]) & (away > away[near])
    ends = np.min(away[other], initial=np.inf) - _NEAREST
    return np.flatnonzero((away > _NEAREST) & (away < min(_FARTHEST, ends)))


def _closes(seen, face, near):
    """Time at which a joint is closed that goes on as at the instant ``near``, NaN where it turns back before [s]."""
    motion, joint = seen.motion, seen.faces[face]
    axis, turn = seen.frames.axes[near, face, :, 1], seen.joints.rotation[near, face]
    rate, bend = (
        (rates[near, joint.upper] - rates[near, joint.lower]) @ axis
        for rates in (motion.angular_velocity, motion.angular_acceleration)
    )
    root = np.sqrt(rate**2 - 2.0 * bend * turn) if rate**2 > 2.0 * bend * turn else np.nan
    return motion.time[near] - 2.0 * turn / (rate + np.sign(rate) * root)


@dataclass(frozen=True)
class _Bodies:
    """Bodies that turn about lines along the second tangent of a face, which move with the table, at an impact.

    ``now`` is the instant nearest to the impact, which is at the time ``at``.
    """

    seen: object
    table: int
    above: np.ndarray
    now: int
    at: float

    def line(self, face, edge):
        """A point of the line at an edge as the resultant shows it, else as the face has it, and its direction."""
        seen = self.seen
        there = seen.states.edge[:, face, 0] == edge
        lever = np.abs(seen.forces.moment[there, face, 1] / seen.forces.force[there, face, 2])
        away = edge * min(np.nanmedian(lever) if len(lever) > _BEARS else np.inf, seen.faces[face].half_width)
        along, axis, _ = seen.frames.axes[self.now, face].T
        return seen.frames.middle[self.now, face] + away * along, axis

    @cached_property
    def inertia_of_each(self):
        """For every body about its mass centre, world frame, (n_above, 3, 3) [kg m2]."""
        turn = self.seen.motion.rotation[self.now, self.above]
        return turn @ self.seen.structure.inertia[self.above] @ np.swapaxes(turn, -1, -2)

    def inertia(self, line, other):
        """Angular momentum about another, parallel line per spin about one [kg m2]."""
        (point, axis), position = line, self.seen.motion.position[self.now, self.above]
        arm, further = np.cross(axis, position - point), np.cross(axis, position - other[0])
        mass = self.seen.structure.mass[self.above]
        return float((axis @ self.inertia_of_each @ axis).sum() + np.einsum("b,bi,bi->", mass, arm, further))

    def momentum(self, line, window):
        """Angular momentum about a line, carried from a window to the impact, and its error, (2,) [kg m2/s]."""
        (point, axis), motion, above = line, self.seen.motion, self.above
        mass, gravity = self.seen.structure.mass[above], np.array(self.seen.structure.file.gravity)
        span = np.arange(min(self.now - 1, window[0]), max(self.now + 1, window[-1]) + 1)
        time = motion.time[span]
        moved = motion.position[span, self.table] - motion.position[self.now, self.table]
        arm = motion.position[span][:, above] - (point + moved)[:, None]
        felt = gravity - motion.acceleration[span, self.table]
        moment = np.einsum("b,tbi,i->t", mass, np.cross(arm, felt[:, None]), axis)
        carried = cumulative_trapezoid(moment, time, initial=0.0)
        rate = motion.velocity[span][:, above] - motion.velocity[span, self.table][:, None]
        about_axis = self.inertia_of_each @ axis
        history = np.einsum("b,tbi,i->t", mass, np.cross(arm, rate), axis)
        history += np.einsum("tbi,bi->t", motion.angular_velocity[span][:, above], about_axis)
        history += np.interp(self.at, time, carried) - carried
        by_rates = np.concatenate(
            [mass[:, None] * np.cross(axis, motion.position[self.now, above] - point), about_axis], axis=1
        )
        variance = np.einsum("bi,bij,bj->", by_rates, motion.rate_covariance[above], by_rates)
        # smoothed noise forgets itself over 2 sqrt(pi) widths
        variance /= 1.0 + np.ptp(motion.time[window]) / (2.0 * np.sqrt(np.pi) * motion.width)
        by_edge = _EDGE_ERROR * mass.sum() * np.linalg.norm(gravity)
        variance += (by_edge * (motion.time[window].mean() - self.at)) ** 2
        return np.array([history[window - span[0]].mean(), np.sqrt(variance)])
