"""Laws that a force from outside may follow, fitted to its history."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from blockshake.forces.outside.push_history import FRICTION

_GRID = 40  # gaps that are tried
_STEP = 0.05  # s, between the starts that are tried
_WITHIN_90 = 2.71  # chi-square of one degree of freedom that nine of ten values stay below
_SHORTEST_PULSE, _LONGEST_PULSE = 0.03, 0.5  # s
_LENGTHS = 6  # of pulses that are tried
_FEWEST = 5  # instants on a side that tell its edge
_EDGE = 5e-3  # m: how far edges are known, where readings tell no better
_ANYWHERE = 1.0  # m, farther than any edge: where both sides tell it
_ALIKE = 1e-8  # determinant of the shapes' correlations, below which readings do not tell them apart
_SECOND = 25.0  # by how much a second spring must lower the sum of squares to be seen


@dataclass(frozen=True)
class FittedLaw:
    """One law fitted to one history.

    Attributes
    ----------
    name : str
        ``steady`` throughout, ``constant`` from an instant on, ``pulse``, ``spring``, ``damper`` or ``proportional``.
    amplitude, error : float
        Of the law and its standard deviation: a force [N]; of a spring [N/m], of a damper [N s/m].
    parameters : dict of str to float
        Start and end [s], gap [m] and side. ``other_gap`` [m] and ``other_amplitude`` [N/m] of a second spring that is
        seen on the other side. ``earliest`` and ``latest``, of a constant force, are the ends of the starts that 90 %
        of such histories agree with, and the start is in their middle.
    chi_square : float
        Sum of squares left, in variances of the history; where the force is not told, of what is beyond its ends.
    information : float
        Bayesian information criterion: ``chi_square + k ln n`` (Schwarz 1978).
    freedom : int
        Told instants less what is fitted to them, 1 at least.
    """

    name: str
    amplitude: float
    error: float
    parameters: dict
    chi_square: float
    information: float
    freedom: int

    def evidence(self, other):
        """By how much it leaves less than another law, or than none, in the mean square that it leaves, 1 at least."""
        return (other.chi_square - self.chi_square) / max(self.chi_square / self.freedom, 1.0)


class _Readings(NamedTuple):
    """History at the known instants: the force where it is told, its ends elsewhere, and what else adds to both."""

    told: np.ndarray
    force: np.ndarray
    error: np.ndarray
    others: (
        np.ndarray
    )  # (n_told, 2): force by metre that the edges lie further out, and by share of more friction
    known: np.ndarray  # of edges and friction: standard deviations before the readings
    lower: np.ndarray
    upper: np.ndarray
    by_lever: np.ndarray


def fit_laws(time, push):
    """Every law fitted to a history, and none: the best first.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        [s]
    push : PushHistory

    Returns
    -------
    list of FittedLaw
        Empty where nothing is told.

    Notes
    -----
    With every law goes how far further out the edges lie than the structure has them, the same to both sides: an edge
    takes up ``shift * edge``, which the history lacks. A block that turned to one side alone tells its edge no better
    than it is known before. With every law goes a share of more friction too: while a joint slips, such friction is in
    the history as a force against the slip.
    """
    bounded = ~push.told & np.isfinite(push.lower + push.error + push.displacement + push.velocity)
    if not push.told.any():
        return []
    known = push.told | bounded
    sides = [np.count_nonzero(push.told & (side * push.edge > 0.0)) for side in (1.0, -1.0)]
    readings = _Readings(
        push.told[known], push.force[known], push.error[known],
        np.column_stack([-push.edge, push.friction])[push.told],
        np.array([_EDGE if min(sides) < _FEWEST else _ANYWHERE, FRICTION]),
        push.lower[known], push.upper[known], push.by_lever[known],
    )  # fmt: skip
    t, u, v = time[known], push.displacement[known], push.velocity[known]
    fits = [_fitted("none", [], readings, {}, 0)]
    fits.append(_fitted("steady", [np.ones_like(t)], readings, {}, 1))
    fits.append(_stepped(t, readings))
    fits.append(_pulse(t, readings))
    fits.append(_with_other_side(_best("spring", _springs(u, (1.0, -1.0)), readings, 2), u, readings))
    fits.append(_fitted("damper", [v], readings, {}, 1))
    fits.append(_fitted("proportional", [u], readings, {}, 1))
    return sorted((one for one in fits if one is not None), key=lambda one: one.information)


def _stepped(t, readings):
    """Force that is constant from an instant on; between two instants that tell, every start is as good."""
    starts = np.arange(t[0], t[-1], _STEP)
    fits = [
        _fitted("constant", [(t >= one).astype(float)], readings, {"start": float(one)}, 2) for one in starts
    ]
    fits = [one for one in fits if one is not None]
    if not fits:
        return None
    least = min(one.chi_square for one in fits)
    near = [one for one in fits if one.chi_square <= least + _WITHIN_90]
    earliest, latest = near[0].parameters["start"], near[-1].parameters["start"]
    middle = min(near, key=lambda one: abs(one.parameters["start"] - 0.5 * (earliest + latest)))
    return replace(middle, parameters={**middle.parameters, "earliest": earliest, "latest": latest})


def _pulse(t, readings):
    """The pulse that lowers the sum of squares most where the force is told: sums over windows tell all of them."""
    told, weight = readings.told, readings.error[readings.told] ** -2
    own, force, others = t[told], readings.force[told], readings.others
    starts, lengths = np.unique(own)[:, None], np.geomspace(_SHORTEST_PULSE, _LONGEST_PULSE, _LENGTHS)
    ends = np.searchsorted(own, np.stack(np.broadcast_arrays(starts, starts + lengths)))
    of_pulse, along, *shared = (
        np.diff(np.concatenate([[0.0], np.cumsum(terms)])[ends], axis=0)[0]
        for terms in (weight, weight * force, *(weight * others.T))
    )
    shared = np.stack(shared, axis=-1)
    # edges and friction take their parts of the pulse and of the force before the two are compared
    taken = np.linalg.inv((others.T * weight) @ others + np.diag(readings.known**-2))
    left = of_pulse - np.einsum("sli,ij,slj->sl", shared, taken, shared)
    along = along - shared @ (taken @ (others.T @ (weight * force)))
    lowers = np.where(left > _ALIKE * of_pulse, along, 0.0) ** 2 / np.maximum(left, 1e-300)
    start, length = np.unravel_index(np.argmax(lowers), lowers.shape)
    first, last = float(starts[start, 0]), float(starts[start, 0] + lengths[length])
    return _fitted(
        "pulse", [((t >= first) & (t < last)).astype(float)], readings, {"start": first, "end": last}, 3
    )


def _springs(u, sides):
    for side in sides:
        largest = (side * u).max()
        for gap in np.linspace(0.0, max(largest, 0.0), _GRID, endpoint=False):
            yield _beyond(u, gap, side), {"gap": float(gap), "side": side}


def _beyond(u, gap, side):
    """Shape of a spring beyond a gap: it pushes back."""
    return -side * np.maximum(side * u - gap, 0.0)


def _with_other_side(spring, u, readings):
    """A spring beyond a gap with a second one on the other side, if what the first one leaves shows it."""
    if spring is None:
        return None
    side, gap = spring.parameters["side"], spring.parameters["gap"]
    fits = []
    for other, parameters in _springs(u, (-side,)):
        both = {"gap": gap, "side": side, "other_gap": parameters["gap"]}
        fits.append(_fitted("spring", [_beyond(u, gap, side), other], readings, both, 4))
    other = _least(fits)
    if other is None or min(other.amplitude, other.parameters["other_amplitude"]) <= 0.0:
        return spring
    return other if spring.chi_square - other.chi_square > _SECOND else spring


def _best(name, shapes, readings, count):
    return _least([_fitted(name, [shape], readings, parameters, count) for shape, parameters in shapes])


def _least(fits):
    fits = [one for one in fits if one is not None]
    return min(fits, key=lambda one: one.chi_square) if fits else None


def _fitted(name, shapes, readings, parameters, count):
    """Amplitudes of one shape or two, with the edges' shift and more friction, by weighted least squares where told.

    None where the told instants do not tell a shape from the others or from a shift of the edges.
    """
    told, weight = readings.told, readings.error[readings.told] ** -2
    design = np.column_stack([*(shape[told] for shape in shapes), readings.others])
    normal = (design * weight[:, None]).T @ design
    others = np.arange(len(shapes), design.shape[1])
    normal[others, others] += readings.known**-2
    size = np.sqrt(np.diag(normal))
    if (size == 0.0).any() or np.linalg.det(normal / np.outer(size, size)) < _ALIKE:
        return None
    found = np.linalg.solve(normal, design.T @ (weight * readings.force[told]))
    amplitudes, (shift, more) = found[: len(shapes)], found[len(shapes) :]
    force = sum((one * shape for one, shape in zip(amplitudes, shapes, strict=True)), np.zeros(len(told)))
    lower = readings.lower - shift * readings.by_lever - force
    upper = readings.upper + shift * readings.by_lever - force
    away = np.maximum(np.maximum(lower, -upper), 0.0)
    away[told] = readings.force[told] - design @ found
    away /= readings.error
    left = float(away @ away) + float((([shift, more] / readings.known) ** 2).sum())
    if len(amplitudes) == 2:
        parameters = parameters | {"other_amplitude": float(amplitudes[1])}
    return FittedLaw(
        name,
        float(amplitudes[0]) if shapes else 0.0,
        float(np.linalg.inv(normal)[0, 0] ** 0.5) if shapes else np.nan,
        parameters,
        left,
        left + count * float(np.log(np.count_nonzero(told))),
        max(int(np.count_nonzero(told)) - count, 1),
    )
